#pragma once

#include <string>
#include <vector>

#include "protocols/psychophysics/definition/handle_text.h"

namespace haptrial::protocols {

struct TrialsDefinition;

/// Reads what would be presented at the ends of every track's range, in every block and, up to a
/// few hundred, in every combination of factors.
/// @returns what there is to say of bodies that give way, as they are presented first, and of the
///          handle with all of them
/// Notes which thresholds each block needs (Block::needs).
/// @throws InputError with the sentences of the first that cannot be presented, and its values
HandleText check_every_value(TrialsDefinition& definition);

}  // namespace haptrial::protocols
