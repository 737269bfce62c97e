#include "core/markers/onset_log.h"

#include <ctime>

namespace haptrial::markers {

OnsetLog::OnsetLog() { sem_init(&wake_, 0, 0); }
OnsetLog::~OnsetLog() { sem_destroy(&wake_); }

void OnsetLog::put(TimedOnset onset) noexcept {
  if (!onset.over) {
    onset.number = count_.load(std::memory_order_relaxed) + 1;
  }
  log_.push(onset);
  if (!onset.over) {
    count_.store(onset.number, std::memory_order_release);
  }
  sem_post(&wake_);
}

void OnsetLog::wake() noexcept { sem_post(&wake_); }

/// steady_clock is CLOCK_MONOTONIC.
void OnsetLog::wait_until(std::chrono::steady_clock::time_point end) noexcept {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(end.time_since_epoch()).count();
  const timespec until{ns / kSecond, ns % kSecond};
  if (sem_clockwait(&wake_, CLOCK_MONOTONIC, &until) == 0) {
    while (sem_trywait(&wake_) == 0) {  // all that was put is taken at once
    }
  }
}

}  // namespace haptrial::markers
