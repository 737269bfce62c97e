#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/base/tool_state.h"
#include "core/bone/simulator/handpiece.h"
#include "core/bone/simulator/simulator.h"

namespace haptrial::bone {

/// Contact of a hand, with the tool that the other hand holds, with bones that the other hand works
/// on: a burr in bone, burr and suction at soft tissue, a plate against the bone; nothing is taken,
/// torn or fixed. A tool that is in bone at first is not felt before it has been free. Servo
/// thread: no allocation, lock, wait or throw after construction.
class BoneTouch {
 public:
  struct Felt {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
    Eigen::Vector3d drag{Eigen::Vector3d::Zero()};   // the part that the turning teeth give [N]
    Eigen::Vector3d shaft{Eigen::Vector3d::Zero()};  // on the burr's shaft, beside `force` [N]
    bool contact{false};                             // with bone
  };

  explicit BoneTouch(const Simulator& simulator);

  /// @param simulator  the same; nobody ticks it meanwhile
  /// @param tool       of the hand that feels
  Felt tick(const Simulator& simulator, const ToolState& tool) noexcept;

 private:
  Felt touch_by_burr(const Simulator& simulator, const BurrTool& burr,
                     const ToolState& tool) noexcept;
  Felt touch_by_plate(const Simulator& simulator, const ToolState& tool) noexcept;
  Eigen::Vector3d touch_soft(const Simulator& simulator, std::span<const BurrShape::Ball> balls,
                             bool sucks, const ToolState& tool) noexcept;
  /// Whether what touches is felt.
  bool lets_feel(bool contact) noexcept;

  std::vector<std::unique_ptr<Drill>> drills_;  // by tool; null where it is no burr
  Shafts shafts_;
  SoftTissue::Touch soft_;
  int tool_{-1};  // in hand
  bool waits_until_free_{true};
};

}  // namespace haptrial::bone
