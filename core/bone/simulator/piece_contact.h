#pragma once

#include <span>

#include "core/base/tool_state.h"
#include "core/bone/drill/drill.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/soft_tissue.h"

namespace haptrial::bone {

/// Immersion of a ball in any piece of bone, summed, in W: for feeling only. Servo thread: no
/// allocation, lock or throw.
Contact touch_pieces(Drill& drill, const BoneWorld& world, const ToolState& tool) noexcept;

/// A ball in a bone's frame.
struct BallAt {
  Eigen::Vector3d centre_B{Eigen::Vector3d::Zero()};  // [m]
  double radius{0.0};                                 // [m]
};
/// The ball of a tool that is deepest in soft tissue; the only one of a tool that has one. Servo
/// thread. @param balls  at least one, along the tool's axis  @param pose  of the bone, X_WB
BallAt deepest_ball(std::span<const BurrShape::Ball> balls, const ToolState& tool,
                    const Eigen::Isometry3d& pose, const SoftTissue& soft) noexcept;

}  // namespace haptrial::bone
