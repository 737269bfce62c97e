#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/device/device.h"
#include "core/device/fault.h"
#include "core/device/force_watch.h"
#include "core/record/rows/session_types.h"
#include "core/stimulus/shown.h"
#include "core/stream/onset_log.h"

namespace haptrial::protocols {

inline constexpr std::size_t kMostDevices = 4;

/// Readings of a session's devices at one tick, in their order, in W.
class Readings {
 public:
  Readings(const device::DeviceReading& only) noexcept : all_(&only, 1) {}  // implicit: one device
  explicit Readings(std::span<const device::DeviceReading> all) noexcept : all_(all) {}
  const device::DeviceReading& operator[](std::size_t device) const noexcept {
    return all_[device];
  }
  std::size_t size() const noexcept { return all_.size(); }
  std::span<const device::DeviceReading> all() const noexcept { return all_; }

 private:
  std::span<const device::DeviceReading> all_;
};

/// Output of one tick of a pass to one device.
struct Drive {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
  device::ForceIntent intent;                      // of the force
  /// Limit of the protocol's own: not even with the guard's damper is the force larger [N]
  double most{std::numeric_limits<double>::infinity()};
  /// The force goes over from one law to another on this tick: what changes by that fades.
  bool goes_over{false};
};

/// Output of one tick of a pass.
struct PassOutput : Drive {  // of the first device
  stimulus::Shown shown;
  double target_force{0.0};  // [N]
  record::Stage stage{record::Stage::kIdle};
  bool saturated{false};   // the device's force limit was reached
  markers::Onsets onsets;  // what begins on this tick, if the pass names its onsets
};

enum class PassState : std::uint8_t { kRunning, kCompleted, kAborted };

/// Anything that drives the devices for a while: one presentation of a stimulus, one drilling.
/// tick() belongs to the servo thread: no allocation, lock, I/O or throw.
class Pass {
 public:
  virtual ~Pass() = default;
  /// Whether the pass may begin; asked every tick until it may.
  virtual bool may_begin() noexcept { return true; }
  /// Begins the pass; called before the first tick. @param sequence  of that tick in the session
  /// file
  virtual void begin(std::uint64_t sequence) noexcept { static_cast<void>(sequence); }
  /// @param dt  since the previous tick [s]
  virtual PassOutput tick(const Readings& readings, double dt) noexcept = 0;
  /// The loop stood still before the next tick: the clock went on, and the ticks did not.
  virtual void note_suspension() noexcept {}
  /// Outputs of the last tick() to the devices after the first, in their order.
  virtual std::span<const Drive> others() const noexcept { return {}; }
  virtual PassState state() const noexcept = 0;
  /// Whether PassOutput::onsets says what begins when; else the stages of PassOutput do.
  virtual bool names_onsets() const noexcept { return false; }
  /// Whether, on a simulated clock, the session's thread has to empty the protocol's own logs, or
  /// to attend to the virtual subject.
  virtual bool wants_attention() noexcept { return false; }
};

/// Records of a protocol of every tick beside the samples, also between passes.
class TickLog {
 public:
  virtual ~TickLog() = default;
  /// Records a tick; called after the pass's tick, if one runs. @param sequence  of the tick in the
  /// session file
  /// @param fault  of a device; kNone: all are well
  /// Servo thread: no allocation, lock, I/O or throw.
  virtual void record(std::uint64_t sequence, const Readings& readings,
                      device::Fault fault) noexcept = 0;
};

}  // namespace haptrial::protocols
