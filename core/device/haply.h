#pragma once

#include <Eigen/Core>
#include <atomic>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/device/device.h"
#include "core/device/haply_link.h"

namespace haptrial::device {

/// How an Inverse3, Inverse3x or Minverse is set up. The defaults suit an Inverse3.
struct HaplyParameters {
  int port{0};                   // of the Inverse Service; 0: 10001, or else 10000
  std::string device_id;         // as the service lists it; empty: the first one
  std::string grip_id;           // of the VerseGrip; empty: the first one, or none if there is none
  double max_force{3.5};         // the driver saturates here > 0 [N]
  double workspace_radius{0.1};  // at most the model's is used > 0 [m]
  Eigen::Vector3d origin{0.0, -0.12,
                         0.15};  // of W in the service's axes, from the mounting face [m]
  double patience{0.018};        // how long one side goes on without word from the other > 0 [s]
  int stop_button{2};            // emergency stop, 0 to 2: a, b and c of the grip; -1: none
};

/// The keys of [haply].
const Schema<HaplyParameters>& haply_schema();

/// Drives an Inverse3, Inverse3x or Minverse, with or without a VerseGrip, by the WebSocket of
/// Haply's Inverse Service (versions 3.0 to 3.5); no library of the maker is needed.
///
/// A thread of its own exchanges messages with the service (HaplyLink); it and the servo loop
/// exchange their newest values, and neither waits for the other. Silence on either side for
/// `patience` is a fault: read() fails when no fresh state came, and the link commands no force
/// when no fresh command came. A connection that ended stays so: the device is opened anew with the
/// next session.
///
/// The service's axes are x to the right, y away from the user and z up, in metres from the
/// mounting face; this driver is the only place that knows (docs/conventions.md).
class HaplyDevice final : public Device {
 public:
  /// @param rate    of the servo loop > 0 [Hz]
  /// @param number  of several devices, from 0: counted from `device_id` in the service's order
  /// @throws RunError when no service answers, or it lists no such device or grip
  HaplyDevice(const HaplyParameters& parameters, double rate, int number = 0);

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;
  const char* trouble() const noexcept override { return trouble_; }
  /// Ticks to which the service brought no fresh state.
  std::uint64_t slow_calls() const noexcept override {
    return stale_.load(std::memory_order_relaxed);
  }

 private:
  HaplyParameters parameters_;
  HaplyLink link_;
  DeviceInfo info_;
  int patience_ticks_;
  HaplyState latest_;
  int ticks_without_news_{0};
  std::atomic<std::uint64_t> stale_{0};
  const char* trouble_{""};
};

}  // namespace haptrial::device
