#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/device/device.h"
#include "core/realtime/latest_value.h"

namespace haptrial::device {

/// How a 3D Systems device is set up. The defaults suit a Touch.
struct OpenHapticsParameters {
  std::string name;               // as the vendor's setup tool named it; empty: the default one
  double max_force{3.3};          // at most the device's own limit is used > 0 [N]
  double max_torque{0.1};         // likewise, of a device with six motors > 0 [N·m]
  double workspace_radius{0.08};  // > 0 [m]
  double patience{0.02};          // how long one side goes on without word from the other > 0 [s]
  int stop_button{1};             // emergency stop; -1: none
};

/// The keys of [open_haptics].
const Schema<OpenHapticsParameters>& open_haptics_schema();

/// Drives a Phantom or Touch through the vendor's OpenHaptics HD library.
///
/// The library insists on a scheduler of its own, whose thread alone may talk to the device. The
/// callback and the servo loop therefore exchange their newest values, and neither waits for the
/// other; a tick reads what the scheduler read at most one of its periods ago. Silence on either
/// side for `patience` is a fault: read() fails when no fresh position came, and the callback lets
/// the force go when no fresh command came.
///
/// The vendor's axes are ours (x right, y up, z to the user), in millimetres. A device with six
/// motors, a Premium 6DOF, gives torque.
class OpenHapticsDevice final : public Device {
 public:
  /// @param rate     of the scheduler and of the servo loop > 0 [Hz]
  /// @param library  a path in place of the search for libHD.so
  /// @throws InputError when the library or one of its functions is missing, RunError when no
  ///         device answers.
  OpenHapticsDevice(const OpenHapticsParameters& parameters, double rate,
                    const std::string& library = "");
  /// Force to zero, scheduler stopped, forces off, closed.
  ~OpenHapticsDevice() override;

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;
  const char* trouble() const noexcept override { return trouble_; }
  /// Periods of the vendor's scheduler that brought no fresh position to a tick.
  std::uint64_t slow_calls() const noexcept override {
    return stale_.load(std::memory_order_relaxed);
  }

 private:
  struct Api;
  struct Sensed {
    DeviceReading reading;
    unsigned error{0};  // of the frame; 0: none
  };
  static unsigned frame(void* self);  // scheduler's thread
  void exchange() noexcept;
  void note_error(unsigned error) noexcept;
  void start(double rate);
  void find_torque();
  void give(const Wrench& wrench) noexcept;
  void close() noexcept;
  void require(const char* what) const;

  OpenHapticsParameters parameters_;
  std::unique_ptr<const Api> api_;
  unsigned device_;
  unsigned long callback_{0};
  bool scheduler_runs_{false};
  DeviceInfo info_;
  int patience_ticks_;
  const char* trouble_{""};

  realtime::LatestValue<Sensed> sensed_;   // scheduler -> servo
  realtime::LatestValue<Wrench> command_;  // servo -> scheduler
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> stale_{0};
  // Servo thread.
  Sensed latest_;
  int ticks_without_news_{0};
  // Scheduler's thread.
  Wrench wrench_;
  int frames_without_command_{0};
  unsigned error_{0};
  int error_frames_{0};  // left, for which it is still told
};

/// Loads the library and lets it go; opens no device. @throws InputError as the device does.
void check_open_haptics_library(const std::string& library = "");

}  // namespace haptrial::device
