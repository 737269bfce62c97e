#pragma once

#include <string>
#include <vector>

#include "core/scene/field.h"

namespace haptrial::protocols {

/// Finds how the bodies among the fields give way, which takes a while if nobody asked for the same
/// before. Session's thread, between trials. @throws InputError as deformable::prepared()
/// @param rate  of the servo loop [Hz]
/// @param real  on the real clock: bodies of their own rate get a thread
void prepare_bodies(std::vector<scene::Field>& fields, double rate, bool real = false);

/// Checks the constants of the bodies among the fields, and that memory suffices to prepare them.
/// @throws InputError as deformable::check_tissue() and check_memory()
void check_bodies(const std::vector<scene::Field>& fields);

/// Whether bodies that move can do so at this rate: prepares them, which takes little.
/// @throws InputError as deformable::steps_on_a_tick() and ticks_of_window()
void prepare_moving_bodies(std::vector<scene::Field>& fields, double rate);

/// Lines about the cost and the stiffness of the bodies among prepared fields.
/// @param rate  of the servo loop [Hz]  @param damping  of the hand of the definition [N·s/m]
std::vector<std::string> words_of_bodies(const std::vector<scene::Field>& fields, double rate,
                                         double damping);

}  // namespace haptrial::protocols
