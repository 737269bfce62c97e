#pragma once

#include <optional>

#include "core/base/random.h"

namespace haptrial::subject {

/// The quantity that is judged, with its unit.
enum class Quantity {
  kForce,       // held through the push [N]
  kStiffness,   // [N/m]
  kCompliance,  // [m/N]
  kViscosity,   // [N·s/m]
  kFriction,    // resisting force while moving [N]
  kRoughness,   // root mean square of the force's fluctuation [N]
  kExtent,      // way between contacts [m]
  kUnevenness,  // how far what was touched lies from a sphere [m]
  kContrast,    // the greatest stiffness of several contacts over their median
  kFrequency,   // of the force's fluctuation [Hz]
  kMass,        // that resists being accelerated [kg]
  kDuration     // from the first touch to the last [s]
};

/// The senses of a hand. Sources of the values: docs/algorithms/virtual-perceiver.md.
struct SenseParameters {
  double force_weber{0.07};        // sd of the log of a felt force >= 0
  double force_floor{0.02};        // sd of a felt force beside that >= 0 [N]
  double displacement_bias{0.53};  // beta: share of a deflection's change that is not felt, 0 to <1
  double displacement_weber{0.0};  // sd of the log of a felt deflection >= 0
  double speed_weber{0.23};        // sd of the log of a felt speed >= 0
  double extent_weber{0.10};       // sd of the log of a felt way >= 0
  double frequency_weber{0.15};    // sd of the log of a felt frequency >= 0
  double mass_weber{0.10};         // sd of the log of a felt mass >= 0
  double duration_weber{0.10};     // sd of the log of a felt duration >= 0
  double usual_deflection{0.01};   // D_0 that is felt as it is > 0 [m]
  double contact_force{0.05};      // below it nothing touches >= 0 [N]
  double moving_speed{0.005};      // below it the hand rests > 0 [m/s]
};

/// @throws std::invalid_argument naming the parameter that breaks its bound.
void check(const SenseParameters& parameters);

/// The hand's contacts in an interval, without noise.
struct ContactEpisode {
  double amount{0.0};  // of the quantity; of compliance its inverse, the stiffness [unit]
  double force{0.0};   // F that it was felt by >= 0 [N]
};

/// The noise of an interval: independent normal deviates, the same for the whole interval. A sense
/// feels one quantity, so `amount` serves all that are felt at once, without a force.
struct FeltNoise {
  double force{0.0}, floor{0.0}, displacement{0.0}, speed{0.0}, amount{0.0};
};
FeltNoise draw_noise(RandomStream& random) noexcept;

/// sd of the log of a quantity that is felt at once, without a force; none for the others.
std::optional<double> weber_at_once(const SenseParameters& senses, Quantity quantity) noexcept;

/// How an encounter is felt. With F^ = F exp(force_weber n1) + force_floor n2:
///
///     force, friction, roughness    F^
///     stiffness                     F^ / D^, D^ = D_0 (D / D_0)^(1 - beta) exp(displacement_weber
///     n3) compliance                    D^ / F^ viscosity                     F^ / (v
///     exp(speed_weber n4)) extent, unevenness            L exp(extent_weber n5) frequency, mass,
///     duration     the amount, times exp(their own weber n5)
///
/// with D = F / K; a contrast as the stiffnesses of two presses with the same force, contrast
/// exp(sqrt(2) force_weber n1 / (1 - beta)). Changes of a deflection are felt too small by beta
/// (Fu, van Paassen and Mulder 2017): pressed with the same force, springs differ to the senses by
/// K^(1 - beta), so that their Weber fraction is force_weber / (1 - beta); pushed to the same
/// place, by K, and the fraction is force_weber. Servo thread: no allocation, lock, I/O or throw.
double felt(const SenseParameters& senses, Quantity quantity, const ContactEpisode& met,
            const FeltNoise& noise) noexcept;

}  // namespace haptrial::subject
