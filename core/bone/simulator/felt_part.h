#pragma once

#include <array>
#include <span>

#include "core/base/tool_state.h"
#include "core/bone/drill/drill.h"
#include "core/bone/drill/feel.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/soft_tissue.h"
#include "core/bone/simulator/tuning.h"

namespace haptrial::bone {

/// A part of a tool that feels bone and takes none of it: a shaft, the end of a tube. It is sampled
/// as a burr at rest. One that is in bone at first is not felt before it has been free.
///
/// Servo thread: no allocation, lock, wait or throw after construction.
class FeltPart {
 public:
  /// @param middle   of its length along the tool's axis, from the tip [m]
  /// @param spacing  of the bone's voxels [m]
  /// @throws std::invalid_argument as BurrShape and check(FeelParameters) do.
  FeltPart(const BurrDimensions& dimensions, double middle, const FeelParameters& feel,
           std::span<const Structure> structures, double spacing,
           const std::array<bool, 256>& soft);

  struct Felt {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
    std::int32_t immersed{0};                        // samples in bone
  };
  /// @param transition  from the feel before feel_as() to its own
  Felt tick(const BoneWorld& world, const ToolState& tool,
            const ForceTransition& transition = {}) noexcept;
  /// Another feel from now on, to which a transition leads.
  void feel_as(const FeelParameters& feel) noexcept {
    before_ = feel_;
    feel_ = feel;
  }
  /// Leaves the part unfelt until it is free.
  void wait() noexcept { waits_until_free_ = true; }

 private:
  double middle_;
  FeelParameters feel_;
  FeelParameters before_;
  BurrParameters at_rest_;
  Drill drill_;
  bool waits_until_free_{true};
};

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
