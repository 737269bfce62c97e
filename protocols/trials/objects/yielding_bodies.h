#pragma once

#include <string>
#include <vector>

#include "core/scene/field.h"

namespace haptrial::protocols {

/// Finds how the bodies among the fields give way, which takes a while if nobody asked for the same
/// before. Session's thread, between trials. @throws InputError as deformable::prepared()
void prepare_bodies(std::vector<scene::Field>& fields);

/// What the bodies among prepared fields cost and how stiff they are, a line each.
/// @param rate  of the servo loop [Hz]  @param damping  of the hand of the definition [N·s/m]
std::vector<std::string> words_of_bodies(const std::vector<scene::Field>& fields, double rate,
                                         double damping);

}  // namespace haptrial::protocols
