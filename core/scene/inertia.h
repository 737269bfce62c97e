#pragma once

#include <Eigen/Core>

#include "core/scene/field_state.h"
#include "core/scene/low_pass.h"

namespace haptrial::scene {

class Inertia;

struct InertiaParameters {
  using Law = Inertia;
  double mass{0.2};                  // m_v >= 0 [kg]
  double acceleration_filter{20.0};  // cut-off f_c > 0 [Hz]

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const { return {.mass = mass, .mass_cutoff = acceleration_filter}; }
};

/// A virtual mass: f = -m_v a_f, with a_f the change of the velocity in a tick behind a first-order
/// low-pass. Not passive: the acceleration is late, so the hand must bring mass of its own.
/// largest_stable_mass() says how much.
class Inertia {
 public:
  Inertia(const InertiaParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const Inertia& before) noexcept;

 private:
  double mass_;
  double rate_;
  LowPass filter_;
  Eigen::Vector3d before_{Eigen::Vector3d::Zero()};  // velocity of the previous tick [m/s]
};

/// How a force comes to be from readings.
struct InertiaLoop {
  double moved_mass{0.22};  // handle and hand m_h > 0 [kg]
  double rate{1000.0};      // 1 / T > 0 [Hz]
  int velocity_window{2};   // readings in the least-squares slope that is the velocity >= 2
  int force_delay{0};       // ticks from a reading to the beginning of its force >= 0
};

/// The virtual mass at which a free mass m_h begins to oscillate [kg]. With p = exp(-2 pi f_c T)
/// and r = m_v / m_h the loop is
///
///     1 - p/z + r (1 - p) q(z) (1/z + 1/z²) z^-d / 2 = 0,
///
/// where q is the velocity estimate as weights on the differences of readings. For q = 1 and d = 0
/// the root is on the unit circle at m_v = 2 m_h / (1 - p): 17 m_h for 20 Hz at 1 kHz.
/// @param cutoff  f_c > 0 [Hz]
/// @throws std::invalid_argument naming the parameter that breaks its bound. Allocates.
double largest_stable_mass(double cutoff, const InertiaLoop& loop);

}  // namespace haptrial::scene
