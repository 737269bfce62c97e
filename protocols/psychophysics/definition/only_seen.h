#pragma once

#include <string>
#include <vector>

namespace haptrial::protocols {

struct TrialsDefinition;

/// Sentences on what a participant who only hears and feels would miss, if the definition is
/// spoken: a stage that shows something to which neither a force leads nor a sound belongs, and a
/// choice that no key gives.
std::vector<std::string> only_seen(const TrialsDefinition& definition);

}  // namespace haptrial::protocols
