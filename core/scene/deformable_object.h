#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "core/contact/renderer.h"
#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/moving_touch.h"
#include "core/deformable/touch/two_rate_touch.h"
#include "core/scene/field_state.h"

namespace haptrial::scene {

class DeformableObject;

/// An object that gives way to the hand.
struct DeformableObjectParameters {
  using Law = DeformableObject;
  deformable::SharedHapticMesh mesh;                   // null: nothing is felt
  deformable::Tissue tissue;                           // of elements that rest on every tick
  std::optional<deformable::SpringTissue> springs;     // of springs that move, instead
  std::optional<deformable::ImplicitTissue> implicit;  // of elements that move, instead
  double rate{0.0};                                    // of what moves; 0: that of the loop [Hz]
  contact::ObjectPose pose;                            // of the body's frame in W
  deformable::TouchOptions tool;
  deformable::SharedCompliance body;               // of mesh and tissue; null until it is prepared
  deformable::SharedMovingBody moving;             // of mesh and what moves; likewise
  deformable::SharedWindowCompliance gives;        // of a body of its own rate; likewise
  deformable::TwoRates rates;                      // of it
  std::shared_ptr<deformable::MovingShape> shape;  // where its vertices are; null: no pictures

  StiffnessBound bound() const;
  FieldTraits traits() const { return {.object = true, .yields = true}; }
  bool moves() const { return springs || implicit; }
  bool prepared() const { return body != nullptr || moving != nullptr; }
};

/// A body that a ball presses, in W: of linear elements at rest, or of springs or elements that
/// move, at the loop's rate or their own (core/deformable/touch). `depth` is how far the ball is
/// in the body as it would be at rest, `proxy` the ball's centre.
class DeformableObject {
 public:
  DeformableObject(const DeformableObjectParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept;
  /// The contact goes on. A body of its own rate goes on as a whole, and is gone from `before`.
  void adopt(DeformableObject& before) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  /// Null: nothing is felt.
  const deformable::BodyTouch* touch() const noexcept { return touch_.get(); }

 private:
  Eigen::Vector3d to_body(const Eigen::Vector3d& p) const noexcept;
  bool is_same_of_own_rate(const DeformableObject& other) const noexcept;

  DeformableObjectParameters parameters_;
  std::unique_ptr<deformable::BodyTouch> touch_;
  double period_;
  Eigen::Vector3d hand_{Eigen::Vector3d::Zero()};  // of the last tick, in W [m]
};

}  // namespace haptrial::scene
