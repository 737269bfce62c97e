#include "core/device/mirrored_device.h"

namespace haptrial::device {
namespace {

Eigen::Vector3d mirrored(const Eigen::Vector3d& v) noexcept { return {-v.x(), v.y(), v.z()}; }

/// A mirror image turns the other way round.
Eigen::Vector3d mirrored_turn(const Eigen::Vector3d& v) noexcept { return {v.x(), -v.y(), -v.z()}; }

}  // namespace

bool MirroredDevice::read(DeviceReading& reading) noexcept {
  if (!device_->read(reading)) {
    return false;
  }
  const Eigen::Quaterniond& q = reading.orientation;
  reading.tool.position = mirrored(reading.tool.position);
  reading.tool.velocity = mirrored(reading.tool.velocity);
  reading.orientation = Eigen::Quaterniond(q.w(), q.x(), -q.y(), -q.z());
  reading.angular_velocity = mirrored_turn(reading.angular_velocity);
  return true;
}

bool MirroredDevice::write(const Wrench& wrench) noexcept {
  Wrench seen = wrench;
  seen.force = mirrored(wrench.force);
  seen.torque = mirrored_turn(wrench.torque);
  return device_->write(seen);
}

}  // namespace haptrial::device
