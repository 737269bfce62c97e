#include "experiments/control/tick_rate.h"

namespace haptrial::experiments {

void TickRate::add(Time now, std::uint64_t ticks) {
  constexpr std::chrono::seconds kWindow{1};
  moments_.push_back({now, ticks});
  while (moments_.size() > 2 && now - moments_[1].time >= kWindow) {
    moments_.pop_front();
  }
}

double TickRate::rate() const {
  constexpr double kShortest = 0.5;  // [s]
  if (moments_.empty()) {
    return 0.0;
  }
  const std::chrono::duration<double> time = moments_.back().time - moments_.front().time;
  const std::uint64_t ticks = moments_.back().ticks - moments_.front().ticks;
  return time.count() < kShortest ? 0.0 : static_cast<double>(ticks) / time.count();
}

}  // namespace haptrial::experiments
