#pragma once

#include <Eigen/Core>
#include <limits>

#include "core/scene/field_state.h"
#include "core/scene/low_pass.h"

namespace haptrial::scene {

class Viscous;

struct ViscousParameters {
  using Law = Viscous;
  double damping{5.0};                                              // b >= 0 [N·s/m]
  double velocity_filter{std::numeric_limits<double>::infinity()};  // cut-off f_c > 0 [Hz]

  StiffnessBound bound() const { return {true, 0.0, damping, -damping}; }
  FieldTraits traits() const { return {.yields = true}; }
};

struct MatrixViscousParameters {
  using Law = Viscous;
  Eigen::Matrix3d matrix{Eigen::Matrix3d::Zero()};  // B, f = B v in W [N·s/m]
  double velocity_filter{30.0};                     // cut-off f_c > 0 [Hz], infinite for none

  StiffnessBound bound() const;
  FieldTraits traits() const { return {}; }
};

/// f = B v_f, with v_f the velocity behind a first-order low-pass (low_pass.h). A damper is B = -b.
///
/// Passive if B + Bᵀ has no positive eigenvalue, and with a filter only if B is also symmetric. A
/// curl field (Shadmehr and Mussa-Ivaldi 1994) has B = -Bᵀ: without a filter it neither gives nor
/// takes; behind a filter it gives energy to a hand that turns with the force, as v_f is late.
class Viscous {
 public:
  Viscous(const ViscousParameters& parameters, const Setting& setting);
  Viscous(const MatrixViscousParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept { filter_.start(hand.velocity); }
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const Viscous& before) noexcept { filter_.adopt(before.filter_); }

 private:
  Eigen::Matrix3d matrix_;
  LowPass filter_;
};

}  // namespace haptrial::scene
