#pragma once

#include <string>
#include <vector>

namespace haptrial::protocols {

struct Definition;
struct TrialQuestion;

/// Sentences on what a participant who only hears and feels would miss, if the definition is
/// spoken: a stage that shows something to which neither a force leads nor a sound belongs, and a
/// choice that no key gives.
std::vector<std::string> only_seen(const Definition& definition,
                                   const std::vector<TrialQuestion>& questions);

}  // namespace haptrial::protocols
