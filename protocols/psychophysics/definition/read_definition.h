#pragma once

#include <memory>
#include <string_view>

#include "core/base/definition/schema_forward.h"
#include "protocols/psychophysics/definition/names.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {

/// The names of a definition, ready to be given values.
std::unique_ptr<Names> read_names(Table& root, const TrialsDefinition& definition);

/// The choice that is right with the values that the names have, from 0.
/// @throws InputError for a value that is no choice's number or word
int right_choice(const Names& names, const TrialQuestion& question);

/// Reads everything but who stands in for people. Problems are noted.
void read_trials_definition(Table& root, std::string_view file_name, TrialsDefinition& definition);

}  // namespace haptrial::protocols
