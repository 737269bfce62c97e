#pragma once

#include <memory>

#include "core/device/device.h"

namespace haptrial::device {

/// A device as a mirror at x = 0 shows it: its handle moves along +x where the hand moves along -x,
/// and forces along +x push the hand along -x. What is laid out for a right hand then comes to a
/// left one as its mirror image, while all that knows the device goes on in W.
///
/// x of positions, velocities and forces change their sign, and y and z of rotations, angular
/// velocities and torques; openings and grip forces stay. Threads as of the device itself.
class MirroredDevice final : public Device {
 public:
  /// @param device  not null
  explicit MirroredDevice(std::unique_ptr<Device> device) : device_(std::move(device)) {}

  const DeviceInfo& info() const noexcept override { return device_->info(); }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;
  bool ready() noexcept override { return device_->ready(); }
  const char* trouble() const noexcept override { return device_->trouble(); }
  std::uint64_t slow_calls() const noexcept override { return device_->slow_calls(); }

 private:
  std::unique_ptr<Device> device_;
};

}  // namespace haptrial::device
