#include "core/stream/onset_log.h"

#include <ctime>

namespace haptrial::markers {

OnsetLog::OnsetLog() { sem_init(&wake_, 0, 0); }
OnsetLog::~OnsetLog() { sem_destroy(&wake_); }

void OnsetLog::put(TickOnsets onsets) noexcept {
  if (onsets.all().empty()) {
    return;
  }
  std::uint64_t count = count_.load(std::memory_order_relaxed);
  for (TimedOnset& onset : onsets.all()) {
    onset.number = onset.over ? 0 : ++count;
  }
  log_.push(onsets);
  count_.store(count, std::memory_order_release);
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
