#pragma once

#include <functional>
#include <vector>

#include "core/device/device.h"

namespace haptrial::test {

/// A device that does what its script says, tick by tick, and keeps every force that it was given.
/// The hand trembles by a nanometre about `position` unless on_read() moves it: a reading that
/// stays the same to the last bit would be a fault.
class ScriptedDevice final : public device::Device {
 public:
  using OnRead = std::function<bool(std::size_t tick, device::DeviceReading& reading)>;
  using OnWrite = std::function<bool(std::size_t tick)>;

  /// Room for `ticks` forces, so that noting them does not allocate.
  explicit ScriptedDevice(std::size_t ticks = 1 << 16) { written.reserve(ticks); }

  const device::DeviceInfo& info() const noexcept override { return info_; }
  bool read(device::DeviceReading& reading) noexcept override {
    device::DeviceReading answer{{position, Eigen::Vector3d::Zero()}, 0};
    answer.tool.position.z() += written.size() % 2 == 0 ? 0.0 : 1e-9;
    if (on_read && !on_read(written.size(), answer)) {
      return false;
    }
    reading = answer;
    return true;
  }
  bool write(const device::Wrench& wrench) noexcept override {
    written.push_back(wrench.force);
    return !on_write || on_write(written.size() - 1);
  }

  bool ready() noexcept override { return !on_ready || on_ready(); }

  std::function<bool()> on_ready;  // none: at once
  OnRead on_read;                  // none: every read succeeds
  OnWrite on_write;                // none: every write succeeds
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};
  std::vector<Eigen::Vector3d> written;  // one a tick [N]

 private:
  device::DeviceInfo info_{"scripted", 12.0, 0.075, true};
};

}  // namespace haptrial::test
