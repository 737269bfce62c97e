#pragma once

#include <string>
#include <string_view>

#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// A table of the constants of each spring: columns kind (length, area, volume), number and
/// constant_J.
std::string constants_csv(const SpringConstants& constants);

/// @param name  of the table, as a message calls it
/// @throws InputError naming table, line and what was found if it is not one of this body.
SpringConstants parse_constants(std::string_view text, const std::string& name,
                                const SpringBody& body);

}  // namespace haptrial::deformable
