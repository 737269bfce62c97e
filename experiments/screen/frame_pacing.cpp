#include "experiments/screen/frame_pacing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace haptrial::experiments {
namespace {

constexpr double kPaceTolerance = 0.25;

}  // namespace

std::int64_t screen_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(ScreenClock::now().time_since_epoch())
      .count();
}

AgreedPace agreed_pace(bool wants_lock, double monitor_rate, double interval, double timer_rate) {
  AgreedPace agreed;
  const bool steady = std::abs(interval * monitor_rate - 1.0) < kPaceTolerance;
  agreed.refresh_locked = wants_lock && monitor_rate > 0.0 && steady;
  agreed.rate = monitor_rate > 0.0 ? monitor_rate : timer_rate;
  if (!agreed.refresh_locked) {
    agreed.notice =
        fmt::format("{}, so a timer draws the screen at {:.0f} Hz and pictures may tear",
                    wants_lock ? "the display does not wait for its monitor's refresh"
                               : "the definition asks for no refresh lock",
                    agreed.rate);
  }
  return agreed;
}

Pace::Pace(const AgreedPace& agreed, std::int64_t now_ns)
    : period_ns_(1e9 / agreed.rate),
      locked_(agreed.refresh_locked),
      last_(now_ns),
      due_(static_cast<double>(last_)) {}

void Pace::wait() {
  std::this_thread::sleep_until(
      ScreenClock::time_point(std::chrono::nanoseconds(next_due(screen_ns()))));
}

std::int64_t Pace::next_due(std::int64_t now_ns) {
  if (locked_) {
    return now_ns;
  }
  due_ += period_ns_;
  const auto now = static_cast<double>(now_ns);
  if (now > due_) {  // at once: to wait for the next in step would make it half a period later yet
    late_ += (now - due_) / period_ns_;
    const double whole = std::floor(late_);
    missed_ += static_cast<std::int32_t>(whole);
    late_ -= whole;
    due_ = now;
    return now_ns;
  }
  return static_cast<std::int64_t>(due_);
}

record::FrameRow Pace::shown(std::int64_t draw_ns, std::int64_t now_ns) {
  const std::int64_t since = now_ns - std::exchange(last_, now_ns);
  if (locked_) {  // pictures come at refreshes, so that their distance tells
    const auto refreshes = std::lround(static_cast<double>(since) / period_ns_);
    missed_ = static_cast<std::int32_t>(std::max(0L, refreshes - 1));
  }
  return {now_ns, draw_ns, std::exchange(missed_, 0)};
}

}  // namespace haptrial::experiments
