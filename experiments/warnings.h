#pragma once

#include <string>
#include <vector>

namespace haptrial::experiments {

struct BoneDefinition;
struct Definition;
struct Experiment;

/// Sentences on what a definition allows but what spoils its data without a word: what was found,
/// and what will happen. None where all is well.
std::vector<std::string> warnings_of(const Experiment& experiment);
std::vector<std::string> warnings_of(const Definition& definition);
std::vector<std::string> warnings_of(const BoneDefinition& definition);

/// Prints each, after "warning: ".
void print_warnings(const Experiment& experiment);

}  // namespace haptrial::experiments
