#pragma once

#include <string>
#include <vector>

#include "protocols/psychophysics/definition/handle_text.h"

namespace haptrial::protocols {

struct TrialsDefinition;

/// Reads what would be presented at the ends of every track's range, in every block and, up to a
/// few hundred, in every combination of factors.
/// @returns what there is to say of rigid bodies, as they are presented first, and of the handle
///          with all values
/// Notes which thresholds each block needs (Block::needs).
/// @throws InputError with the sentences of the first that cannot be presented, and its values
HandleText check_every_value(TrialsDefinition& definition);

/// Words about the bodies that give way, as they are presented first: how stiff they are, and what
/// they cost on a tick of this machine. Prepares and touches them, which takes a while.
/// @param definition  that was checked
std::vector<std::string> costs_of_bodies(const TrialsDefinition& definition);

}  // namespace haptrial::protocols
