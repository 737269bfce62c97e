#include "core/realtime/servo_loop.h"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>

namespace haptrial::realtime {
namespace {

std::int64_t now_ns() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

// A thread wakes late from its sleep; the last of the wait is therefore spent looking at the clock.
// docs/algorithms/servo-loop.md has what that costs and brings.
constexpr double kSpinNs = 100e3;
constexpr double kSpinShare = 0.1;  // of a period, at most

// Waits until the time on CLOCK_MONOTONIC, or not at all when it has passed.
// @returns the time when the wait was over.
std::int64_t wait_until(std::int64_t time_ns, std::int64_t spin_ns) noexcept {
  const std::int64_t wake = time_ns - spin_ns;
  const timespec until{wake / 1'000'000'000, wake % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  std::int64_t now = now_ns();
  while (now < time_ns) {
    now = now_ns();
  }
  return now;
}

}  // namespace

ServoLoop::ServoLoop(ClockKind clock, double rate_hz)
    : clock_(clock), rate_hz_(rate_hz), period_ns_(1e9 / rate_hz) {
  if (!(rate_hz > 0.0 && rate_hz <= 1e6)) {
    throw std::invalid_argument("ServoLoop: the rate must be above 0 and at most 1e6 Hz");
  }
}

void ServoLoop::run(ServoTask& task) {
  clock_ == ClockKind::kSimulated ? run_simulated(task) : run_real(task);
}

std::int64_t ServoLoop::elapsed_ns() const noexcept {
  if (clock_ == ClockKind::kSimulated) {
    return static_cast<std::int64_t>(static_cast<double>(ticks()) / rate_hz_ * 1e9);
  }
  const std::int64_t origin = origin_ns_.load(std::memory_order_acquire);
  return origin < 0 ? 0 : now_ns() - origin;
}

void ServoLoop::run_simulated(ServoTask& task) {
  const double dt = 1.0 / rate_hz_;
  bool more = true;
  for (std::uint64_t index = ticks(); more && !stop_requested(); ++index) {
    // The time comes from the index each time: no rounding adds up.
    const double time_ns = static_cast<double>(index) * period_ns_;
    more = task.tick({index, static_cast<std::int64_t>(time_ns + 0.5), dt});
    ticks_.store(index + 1, std::memory_order_relaxed);
  }
}

void ServoLoop::run_real(ServoTask& task) {
  const RealTimeScope scope;
  status_ = scope.status();
  const double dt = 1.0 / rate_hz_;
  const auto spin_ns = static_cast<std::int64_t>(std::min(kSpinNs, kSpinShare * period_ns_));
  Deadlines deadlines(period_ns_, now_ns());
  std::int64_t origin = origin_ns_.load(std::memory_order_relaxed);
  bool more = true;
  for (std::uint64_t index = ticks(); more && !stop_requested(); ++index) {
    const std::int64_t start = wait_until(deadlines.wake(), spin_ns);
    if (stop_requested()) {
      break;
    }
    const Deadlines::Start begun = deadlines.start(start);
    note_start(begun);
    if (origin < 0) {
      origin = start;
      origin_ns_.store(start, std::memory_order_release);
    }
    more = task.tick({index, start - origin, dt, begun.resynchronised ? begun.lateness : 0});
    const std::int64_t end = now_ns();
    timing_.compute.add(end - start);
    overruns_.fetch_add(deadlines.end(end) ? 1 : 0, std::memory_order_relaxed);
    ticks_.store(index + 1, std::memory_order_relaxed);
  }
}

void ServoLoop::note_start(const Deadlines::Start& start) noexcept {
  timing_.lateness.add(start.lateness);
  if (start.period) {
    timing_.period.add(*start.period);
  }
  resynchronised_.fetch_add(start.resynchronised ? 1 : 0, std::memory_order_relaxed);
}

}  // namespace haptrial::realtime
