#pragma once

#include <string>
#include <vector>

#include "core/scene/field.h"

namespace haptrial::protocols {

/// Lines about the means that keep each rigid object among fields from shaking at the rate of the
/// loop, or that nothing is proven of it; and that a body is a room.
/// @param rate  of the servo loop [Hz]  @param damping  of the hand of the definition [N·s/m]
std::vector<std::string> words_of_rigid_objects(const std::vector<scene::Field>& fields,
                                                double rate, double damping);

}  // namespace haptrial::protocols
