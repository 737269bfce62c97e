#pragma once

namespace haptrial::protocols {

struct TrialsDefinition;

/// Reads what would be presented at the ends of every track's range, in every block and, up to a
/// few hundred, in every combination of factors.
/// @throws InputError with the sentences of the first that cannot be presented, and its values
void check_every_value(const TrialsDefinition& definition);

}  // namespace haptrial::protocols
