#pragma once

#include <Eigen/Core>

#include "core/control/pd_controller.h"
#include "core/scene/field_state.h"

namespace haptrial::scene {

class Hold;

/// Spring to a point: f = sat(k (to - p) - b v, limit).
struct SpringParameters {
  using Law = Hold;
  Eigen::Vector3d to{Eigen::Vector3d::Zero()};  // [m]
  control::PdGains gains{300.0, 3.0};           // k >= 0 [N/m], b >= 0 [N·s/m]

  StiffnessBound bound() const { return {true, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {.leads_to = to}; }
};

/// Spring to the straight line through two points, endless: f = sat(-k P (p - from) - b P v, limit)
/// with P = 1 - u uᵀ and u along the line. Free along u: an error clamp.
struct LineChannelParameters {
  using Law = Hold;
  Eigen::Vector3d from{Eigen::Vector3d::Zero()};  // [m]
  Eigen::Vector3d to{0.0, 0.0, -0.1};             // not `from` [m]
  control::PdGains gains{1000.0, 15.0};

  StiffnessBound bound() const { return {true, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {}; }
};

/// Spring to the axes of W that are free through a point; P keeps the others. With two free axes a
/// plane.
struct AxisChannelParameters {
  using Law = Hold;
  Eigen::Vector3d through{Eigen::Vector3d::Zero()};  // [m]
  bool free_x{true};
  bool free_y{false};
  bool free_z{true};
  control::PdGains gains{1000.0, 15.0};

  StiffnessBound bound() const { return {true, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {}; }
};

/// Spring to a plane from both sides (a wall is felt from one): P = n nᵀ.
struct PlaneParameters {
  using Law = Hold;
  Eigen::Vector3d through{Eigen::Vector3d::Zero()};  // [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // any length above 0
  control::PdGains gains{1000.0, 15.0};

  StiffnessBound bound() const { return {true, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {}; }
};

/// A spring and damper along some directions, which P projects on, and freedom along the others:
///
///     f = sat(-k P (p - p_0) - b P v, limit)
///
/// Passive: the spring is minus the gradient of E(|P (p - p_0)|), a parabola that goes on straight
/// from the limit, and the limited sum takes energy from the hand beyond that, as sat() is a
/// projection on a ball and thus monotone.
class Hold {
 public:
  Hold(const SpringParameters& parameters, const Setting& setting);
  Hold(const LineChannelParameters& parameters, const Setting& setting);
  Hold(const AxisChannelParameters& parameters, const Setting& setting);
  Hold(const PlaneParameters& parameters, const Setting& setting);

  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  double energy(const Eigen::Vector3d& p) const noexcept;  // [J]

 private:
  Hold(const Eigen::Vector3d& place, const Eigen::Matrix3d& held, const control::PdGains& gains,
       const Setting& setting);

  Eigen::Vector3d place_;
  Eigen::Matrix3d held_;  // P
  control::PdController controller_;
  double limit_;
};

}  // namespace haptrial::scene
