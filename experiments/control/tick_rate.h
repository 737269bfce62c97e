#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace haptrial::experiments {

/// Ticks per second over the last second. One thread.
class TickRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// How many ticks there have been so far. @param now  never earlier than before
  void add(Time now, std::uint64_t ticks);
  /// [Hz]; 0 until two moments at least half a second apart are known.
  double rate() const;

 private:
  struct Moment {
    Time time;
    std::uint64_t ticks;
  };
  std::deque<Moment> moments_;  // of the last second, and the one before them
};

}  // namespace haptrial::experiments
