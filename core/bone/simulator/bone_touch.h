#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/base/tool_state.h"
#include "core/bone/simulator/simulator.h"

namespace haptrial::bone {

/// What a hand feels of bones that another hand works on: the contact of the burr that the other
/// one holds, and nothing is taken. A tool that is in bone at first is not felt before it has been
/// free. Servo thread: no allocation, lock, wait or throw after construction.
class BoneTouch {
 public:
  struct Felt {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
    Eigen::Vector3d drag{Eigen::Vector3d::Zero()};   // the part that the turning teeth give [N]
    bool contact{false};
  };

  explicit BoneTouch(const Simulator& simulator);

  /// @param simulator  the same; nobody ticks it meanwhile
  /// @param tool       of the hand that feels
  Felt tick(const Simulator& simulator, const ToolState& tool) noexcept;

 private:
  std::vector<std::unique_ptr<Drill>> drills_;  // by tool; null where it is no burr
  int tool_{-1};                                // in hand
  bool waits_until_free_{true};
};

}  // namespace haptrial::bone
