#pragma once

#include <Eigen/Core>

#include "core/control/minimum_jerk.h"
#include "core/control/pd_controller.h"
#include "core/scene/field_state.h"

namespace haptrial::scene {

class Mover;

struct MoverParameters {
  using Law = Mover;
  Eigen::Vector3d to{Eigen::Vector3d::Zero()};  // [m]
  double duration{0.8};                         // of the move > 0 [s]
  control::PdGains gains{300.0, 20.0};          // k >= 0 [N/m], b >= 0 [N·s/m]

  StiffnessBound bound() const { return {false, gains.stiffness, gains.damping}; }
  FieldTraits traits() const { return {.timed = true, .leads_to = to}; }
};

/// Leads the hand from where it is when the field is switched on: a spring and damper to a point
/// that makes a minimum-jerk move (Flash and Hogan 1985) and then stays. Active.
class Mover {
 public:
  Mover(const MoverParameters& parameters, const Setting& setting);
  void start(const PointState& hand) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const Mover& before) noexcept { move_ = before.move_; }

 private:
  Eigen::Vector3d to_;
  double duration_;
  control::PdController controller_;
  control::MinimumJerkMove move_;
};

}  // namespace haptrial::scene
