#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/device/device.h"
#include "core/device/energy_watch.h"
#include "core/record/drilling_types.h"
#include "core/record/session_types.h"
#include "core/stimulus/presentation.h"

namespace haptrial::protocols {

/// What one tick of a pass asks for.
struct PassOutput {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
  device::ForceIntent intent;                      // of the force
  stimulus::Presentation presentation;
  double target_force{0.0};   // [N]
  double applied_force{0.0};  // by the participant, downward > 0 [N]
  record::Stage stage{record::Stage::kIdle};
  bool saturated{false};      // the device's force limit was reached
  double damping_share{1.0};  // of the damping that the definition asks for
  record::ToolRow tool;       // of a drilling; what the device gave is filled in by the task
};

enum class PassState : std::uint8_t { kRunning, kCompleted, kAborted };

/// Anything that drives the device for a while: one presentation of a stimulus, one drilling.
/// tick() belongs to the servo thread: no allocation, lock, I/O or throw.
class Pass {
 public:
  virtual ~Pass() = default;
  /// Before the first tick. @param sequence  of that tick in the session file
  virtual void begin(std::uint64_t sequence) noexcept { static_cast<void>(sequence); }
  /// @param reading  of the device, in W;  @param dt  since the previous tick [s]
  virtual PassOutput tick(const device::DeviceReading& reading, double dt) noexcept = 0;
  virtual PassState state() const noexcept = 0;
  /// On a simulated clock: whether the session's thread has to empty this pass's own logs.
  virtual bool wants_attention() noexcept { return false; }
};

}  // namespace haptrial::protocols
