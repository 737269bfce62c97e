#include "core/device/replay.h"

#include <stdexcept>
#include <utility>

namespace haptrial::device {

ReplayDevice::ReplayDevice(std::vector<PointState> hand, double rate, const DeviceInfo& recorded)
    : hand_(std::move(hand)), rate_(rate), info_(recorded) {
  if (hand_.empty() || !(rate > 0.0)) {
    throw std::invalid_argument(
        "ReplayDevice: the recording must not be empty and the rate must be above 0");
  }
  info_.name = recorded.name.empty() ? "replay" : "replay of " + recorded.name;
  info_.simulated = true;
}

bool ReplayDevice::read(DeviceReading& reading) noexcept {
  if (over()) {
    return false;
  }
  reading.tool = hand_[next_];
  reading.buttons = 0;
  reading.forces_on = true;
  return true;
}

bool ReplayDevice::write(const Eigen::Vector3d&) noexcept {
  next_ += over() ? 0 : 1;
  return true;
}

const char* ReplayDevice::trouble() const noexcept {
  return over() ? "the recording has come to its end" : "";
}

double ReplayDevice::duration() const noexcept { return static_cast<double>(hand_.size()) / rate_; }

}  // namespace haptrial::device
