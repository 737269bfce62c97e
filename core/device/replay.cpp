#include "core/device/replay.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace haptrial::device {

ReplayDevice::ReplayDevice(std::vector<PointState> hand, double rate, const DeviceInfo& recorded,
                           std::vector<std::size_t> starts)
    : hand_(std::move(hand)), rate_(rate), info_(recorded), starts_(std::move(starts)) {
  if (hand_.empty() || !(rate > 0.0)) {
    throw std::invalid_argument(
        "ReplayDevice: the recording must not be empty and the rate must be above 0");
  }
  if (!std::is_sorted(starts_.begin(), starts_.end()) ||
      (!starts_.empty() && starts_.back() >= hand_.size())) {
    throw std::invalid_argument("ReplayDevice: the starts must ascend within the recording");
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

bool ReplayDevice::write(const Wrench&) noexcept {
  const bool held = passes_ < starts_.size() && next_ + 1 >= starts_[passes_];
  next_ += over() || held ? 0 : 1;
  return true;
}

bool ReplayDevice::ready() noexcept {
  if (passes_ >= starts_.size()) {
    return starts_.empty();
  }
  if (next_ + 1 < starts_[passes_]) {
    return false;
  }
  next_ = starts_[passes_++];
  return true;
}

const char* ReplayDevice::trouble() const noexcept {
  return over() ? "the recording has come to its end" : "";
}

double ReplayDevice::duration() const noexcept { return static_cast<double>(hand_.size()) / rate_; }

}  // namespace haptrial::device
