#pragma once

#include <string>

#include "core/control/handle_loop.h"

namespace haptrial::control {

/// Demand of a spring and damper on the hand, from the bare handle to a heavy one, with forces that
/// come one to three ticks late.
struct LoopMargin {
  std::string name;  // of the table in the definition
  control::PdGains gains;
  double lightest{0.0};        // hand that carries all the damping, force_delay as given [kg]
  double lightest_late{0.0};   // three ticks late [kg]
  double bare_damping{0.0};    // what the bare handle gets [N·s/m]
  double bare_stiffness{0.0};  // that it carries with that damping, three ticks late [N/m]
};

/// Heaviest hand that gains may need [kg]; gains that need a heavier one are refused.
constexpr double kHeaviestHand = 2.0;
/// Heaviest that gains on a rotation or a grip may need at the fingers, likewise [kg].
constexpr double kHeaviestFingers = 0.25;

/// @returns a delay as sentences name it: "a tick", "3 ticks"
std::string ticks_in_words(int ticks);

/// The least that the bare handle gets of a spring and a damper.
struct BareHandle {
  double damping{0.0};    // [N·s/m]
  double stiffness{0.0};  // that it carries with that damping [N/m]
};
BareHandle bare_handle(const control::PdGains& gains, const control::HandleLoop& loop);

LoopMargin loop_margin(const std::string& name, const control::PdGains& gains,
                       const control::HandleLoop& loop);

/// A sentence, such as "plane: 2000 N/m and 300 N·s/m need a hand of 0.73 kg (1.21 kg where forces
/// come three ticks late); a lighter one gets less damping, the bare handle 15.7 N·s/m".
std::string describe(const LoopMargin& margin);

/// Whether the bare handle oscillates whatever the damping: the envelope then ends passes.
bool is_dangerous(const LoopMargin& margin);

}  // namespace haptrial::control
