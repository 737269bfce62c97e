#include "core/tutoring/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace haptrial::tutoring {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kOtherWay = 20'000'000;  // more than jitter changes a round trip [ns]

void ClockOffset::add(std::int64_t sent, std::int64_t heard, std::int64_t answered,
                      std::int64_t now) noexcept {
  const std::int64_t round_trip = (now - sent) - (answered - heard);
  if (round_trip < 0) {
    return;  // one of the clocks was set, or the times are not of one message
  }
  const std::int64_t there = heard - sent;
  const std::int64_t back = answered - now;
  const Answer answer{now, back + (there - back) / 2, round_trip};
  last_round_trip_ = round_trip;
  least_round_trip_ = least_round_trip_ < 0 ? round_trip : std::min(least_round_trip_, round_trip);
  if (best_.round_trip < 0) {
    second_ends_ = now + kSecond;
  }
  if (best_.round_trip < 0 || round_trip < best_.round_trip) {
    best_ = answer;
  }
  if (now >= second_ends_) {
    const bool changed = count_ > 0 && std::abs(best_.round_trip - trip_before_) > kOtherWay;
    trip_before_ = best_.round_trip;
    if (!changed) {
      kept_[count_++ % kSeconds] = best_;
      fit();
    }
    best_ = {};
  }
}

/// Times and offsets are taken beside the oldest kept: a double holds no nanoseconds since 1970.
void ClockOffset::fit() noexcept {
  const std::size_t n = std::min(count_, kSeconds);
  const std::int64_t first = kept_[0].time;
  base_ = kept_[0].offset;
  double t = 0.0;
  double o = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    t += static_cast<double>(kept_[i].time - first) / static_cast<double>(n);
    o += static_cast<double>(kept_[i].offset - base_) / static_cast<double>(n);
  }
  double tt = 0.0;
  double to = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double dt = static_cast<double>(kept_[i].time - first) - t;
    tt += dt * dt;
    to += dt * (static_cast<double>(kept_[i].offset - base_) - o);
  }
  drift_ = tt > 0.0 ? to / tt : 0.0;
  mean_time_ = first + std::llround(t);
  mean_offset_ = o;
}

std::int64_t ClockOffset::offset(std::int64_t now) const noexcept {
  if (count_ == 0) {
    return best_.offset;
  }
  return base_ + std::llround(mean_offset_ + drift_ * static_cast<double>(now - mean_time_));
}

}  // namespace haptrial::tutoring
