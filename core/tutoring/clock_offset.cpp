#include "core/tutoring/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::tutoring {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kOtherWay = 5'000'000;  // more than jitter adds to the quickest transit [ns]
constexpr int kMostLeftOut = 4;                // seconds in a row

void ClockOffset::add(std::int64_t sent, std::int64_t heard, std::int64_t answered,
                      std::int64_t now) noexcept {
  const std::int64_t round_trip = (now - sent) - (answered - heard);
  if (round_trip < 0) {
    return;  // one of the clocks was set, or the times are not of one message
  }
  const std::int64_t there = heard - sent;
  const std::int64_t back = now - answered;
  const Answer answer{now, (there - back) / 2, round_trip, {there, back}};
  last_round_trip_ = round_trip;
  if (best_.round_trip < 0) {
    second_ends_ = now + kSecond;
  }
  if (best_.round_trip < 0 || round_trip < best_.round_trip) {
    best_ = answer;
  }
  least_.back().there = std::min(least_.back().there, there);
  least_.back().back = std::min(least_.back().back, back);
  if (now >= second_ends_) {
    end_second();
  }
}

/// Judges the second before, as those beside it are known now.
void ClockOffset::end_second() noexcept {
  if (before_.round_trip >= 0 && (is_of_one_network(before_) || left_out_ == kMostLeftOut)) {
    kept_[count_++ % kSeconds] = before_;
    left_out_ = 0;
    fit();
  } else if (before_.round_trip >= 0) {
    ++left_out_;
  }
  before_ = std::exchange(best_, {});
  least_ = {least_[1], least_[2], {}};
}

/// Whether both of its transits were about as quick as any of three seconds.
bool ClockOffset::is_of_one_network(const Answer& answer) const noexcept {
  return std::ranges::all_of(least_, [&](const Transits& least) {
    return answer.transits.there - kOtherWay <= least.there &&
           answer.transits.back - kOtherWay <= least.back;
  });
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
    return before_.round_trip >= 0 ? before_.offset : best_.offset;
  }
  return base_ + std::llround(mean_offset_ + drift_ * static_cast<double>(now - mean_time_));
}

}  // namespace haptrial::tutoring
