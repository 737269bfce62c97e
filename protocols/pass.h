#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/point_state.h"
#include "core/record/session_types.h"
#include "core/stimulus/presentation.h"

namespace haptrial::protocols {

/// What one tick of a pass asks for.
struct PassOutput {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
  stimulus::Presentation presentation;
  double target_force{0.0};   // [N]
  double applied_force{0.0};  // by the participant, downward > 0 [N]
  record::Stage stage{record::Stage::kIdle};
  bool saturated{false};  // the device's force limit was reached
};

enum class PassState : std::uint8_t { kRunning, kCompleted, kAborted };

/// Anything that drives the device for a while: one presentation of a stimulus, one drilling.
/// tick() belongs to the servo thread: no allocation, lock, I/O or throw.
class Pass {
 public:
  virtual ~Pass() = default;
  /// @param tool  as read from the device, in W;  @param dt  since the previous tick [s]
  virtual PassOutput tick(const PointState& tool, double dt) noexcept = 0;
  virtual PassState state() const noexcept = 0;
};

}  // namespace haptrial::protocols
