#pragma once

#include "core/control/pd_controller.h"

namespace haptrial::control {

/// The part of the loop between a spring and damper in software and the hand, along one axis.
struct HandleLoop {
  double handle_mass{0.22};   // of the bare handle, m_h > 0 [kg]
  double rate{1000.0};        // of the loop, 1 / T > 0 [Hz]
  int velocity_window{8};     // readings in the slope that estimates velocity >= 2
  int force_delay{1};         // ticks from a command to the force >= 1
  double velocity_step{0.0};  // velocity_of_a_step() of the device >= 0 [m/s]
};

/// The velocity that the estimate shows of a handle that is still, by one step of the encoder in
/// the middle of its window [m/s]:
///
///     dv = 1.5 q n / ((n^2 - 1) T)
///
/// @param quantum  q of the encoder >= 0 [m]  @param window  n readings >= 2  @param rate  1 / T
/// [Hz]
double velocity_of_a_step(double quantum, int window, double rate) noexcept;

/// A hand that adds to the handle, along one axis. The default: nobody holds it.
struct HeldBy {
  double mass{0.0};       // >= 0 [kg]
  double damping{0.0};    // >= 0 [N·s/m]
  double stiffness{0.0};  // about where it wants to be >= 0 [N/m]
};

/// Largest modulus of the eigenvalues of the sampled loop: the force f = -k p - b v of a reading is
/// held for a tick and acts force_delay ticks later, v is the least-squares slope over the last
/// readings. Below 1 the loop is stable. Allocates.
/// @throws std::invalid_argument where a parameter is out of its bounds.
double spectral_radius(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand);

/// Frequency at which the loop swings most, by the eigenvalue of the largest modulus [Hz].
double dominant_frequency(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand);

/// The lightest hand, a pure mass, with which the loop is stable [kg]: 0 where the bare handle
/// is, `heaviest` + 1 where not even that hand is enough.
double lightest_stable_hand(const PdGains& gains, const HandleLoop& loop, double heaviest = 2.0);

/// A hand that is held as hands of this mass are: 15 N·s/m and 250 N/m at 0.8 kg.
HeldBy held_by_hand(double mass) noexcept;

/// Whether an oscillation grows so slowly, if at all, that nobody feels it: its amplitude is less
/// than doubled within 0.2 s. Springs without a damper never let a free mass come quite to rest;
/// friction of the handle does. Allocates.
bool is_calm(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand);

/// The lightest hand (held_by_hand) with which the loop is calm [kg]: 0 where a handle that nobody
/// holds is, `heaviest` + 1 where not even that hand is enough. Allocates.
double lightest_calm_hand(const PdGains& gains, const HandleLoop& loop, double heaviest = 2.0);

/// The damping that the bare handle carries with a margin [N·s/m]:
///
///     b_0 = min(b, m_h / (2 tau)),    tau = (n / 2 + 3) T
///
/// Damping by a velocity that is tau old is stable on a free mass m below (pi / 2) m / tau; b_0 is
/// a third of that. tau: n readings are (n - 1) / 2 ticks old, the hold takes half a tick, and the
/// force comes up to three ticks after the reading, whatever force_delay says.
double damping_of_bare_handle(double damping, const HandleLoop& loop) noexcept;

}  // namespace haptrial::control
