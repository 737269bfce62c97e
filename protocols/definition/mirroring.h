#pragma once

#include <string>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

struct Definition;

/// Reads the key `mirror_left_handed` of a [design] table: left-handed participants feel and see
/// everything as a mirror at x = 0 shows it (device::MirroredDevice).
void read_mirroring(Table& design, Definition& definition);

/// Prepares the definition for a session of this participant. Nothing where it mirrors nobody.
/// @param handedness  as told when the session begins
/// @throws InputError where it mirrors, and the hand is neither "left" nor "right"
void mirror_for(const std::string& handedness, Definition& definition);

}  // namespace haptrial::protocols
