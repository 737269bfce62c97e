#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace haptrial::protocols {

struct Definition;
struct TrialQuestion;

/// Sentences on what a participant who only hears and feels would miss, if the definition is
/// spoken: a stage that shows something to which neither a force leads nor a sound belongs, and a
/// choice that no key gives.
std::vector<std::string> only_seen(const Definition& definition,
                                   const std::vector<TrialQuestion>& questions);

/// Sentences on words that formulas of a definition compare something with, "$shape == 'spere'",
/// and that stand nowhere else in it: nothing is ever equal to them. None where all is well.
/// @param definition  its text
std::vector<std::string> unmatched_literals(std::string_view definition);

}  // namespace haptrial::protocols
