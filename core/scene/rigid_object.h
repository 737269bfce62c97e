#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/contact/felt_body.h"
#include "core/contact/renderer.h"
#include "core/control/pd_controller.h"
#include "core/scene/field_state.h"
#include "core/scene/found_end.h"
#include "core/scene/surface.h"

namespace haptrial::scene {

class RigidObject;

/// An object that is felt by its triangles.
struct RigidObjectParameters {
  using Law = RigidObject;
  contact::SharedBody body;            // null: nothing is felt
  contact::ObjectPose pose;            // of the body's frame in W
  double scale{1.0};                   // lengths of W over those of the body > 0
  control::PdGains gains{800.0, 2.0};  // k > 0 [N/m], b >= 0 [N·s/m]
  contact::Friction friction;
  double tool_radius{0.0};    // of the hand; 0: a point [m]
  double crease_angle{-1.0};  // of force shading, 0 to pi / 2; negative: none [rad]
  contact::RendererKind renderer{contact::RendererKind::kProxy};
  int resolution{64};  // of voxel and distance field: cells along the longest side

  StiffnessBound bound() const;
  FieldTraits traits() const {
    return {.surface = true, .closes_in = true, .object = true, .yields = true};
  }
};

/// A mesh rendered by its proxy (core/contact), in W, with the shares of k and b that the handle
/// carries:
///
///     f = max(0, k |pushed| + b d|pushed| / dt) n + k dragged
///
/// With reliefs h on it, of which none is higher than H anywhere, and g = n - ∇h,
///
///     e = |pushed| + h(p) - H,   f = clip(k e - b g · v, 0, F) g + k dragged   if e > 0
///
/// so that the highest ridges lie at the mesh and grooves below it. F as in surface.h. Where the
/// proxy falls over an edge the force follows by degrees (FoundEnd). A hand that
/// is inside a closed body when the field is switched on is felt as pushed out to the nearest
/// place of its surface.
class RigidObject {
 public:
  RigidObject(const RigidObjectParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept;
  void adopt(const RigidObject& before) noexcept;
  void lay(const ReliefHere& relief) noexcept { relief_ = relief; }  // before force()
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  const SurfaceTouch& touch() const noexcept { return touch_; }
  /// Stored energy, as Surface has it; energy that friction holds is left out.
  double stored(double depth, double share) const noexcept;

 private:
  Eigen::Vector3d to_body(const Eigen::Vector3d& p) const noexcept;
  void begin_at(const Eigen::Vector3d& p) noexcept;
  Eigen::Vector3d push(const contact::Contact& contact, const Felt& felt,
                       FieldState& state) noexcept;
  Eigen::Vector3d follow(const Eigen::Vector3d& force, const Felt& felt,
                         FieldState& state) noexcept;

  RigidObjectParameters parameters_;
  std::unique_ptr<contact::Renderer> renderer_;
  double period_;
  double limit_;
  ReliefHere relief_;
  SurfaceTouch touch_;
  FoundEnd end_;
  bool slid_{false};                                // on the tick before
  Eigen::Vector3d proxy_{Eigen::Vector3d::Zero()};  // of the last tick, in W [m]
};

}  // namespace haptrial::scene
