#pragma once

#include <string>
#include <string_view>

#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// A table of the constants of each spring: a line that says whose they are, then the columns kind
/// (length, area, volume), number and constant_J.
/// @param body  whose shape at rest that line tells
std::string constants_csv(const SpringBody& body, const SpringConstants& constants);

/// @param name  of the table, as a message calls it
/// @throws InputError naming table, line and what was found if it is not one of this body: of as
/// many springs, and, where the table says so, which older ones do not, of the same volume
/// and length of all edges.
SpringConstants parse_constants(std::string_view text, const std::string& name,
                                const SpringBody& body);

}  // namespace haptrial::deformable
