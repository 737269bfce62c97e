#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace haptrial::experiments {

/// Whether the servo loop keeps its rate. Session's thread.
///
/// A pass with too many overruns is told (analysis/quality/timing.h says how many).
/// A loop that makes less than four fifths of its ticks over a second, more than a fifth of them
/// overruns, does not catch up: it is overloaded, as with a device whose library takes longer than
/// a period. One delay that is caught up with, and a suspension, are neither.
class LoopWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  explicit LoopWatch(double rate_hz) : rate_hz_(rate_hz) {}

  void begin_pass(std::uint64_t ticks, std::uint64_t overruns);
  /// Takes the loop's counts so far. @param now  never earlier than before
  /// @returns a sentence when the last second of the pass was overloaded.
  std::optional<std::string> overloaded(Time now, std::uint64_t ticks, std::uint64_t overruns);
  /// @returns what record::too_many_overruns() says of the pass.
  std::optional<std::string> end_pass(std::uint64_t ticks, std::uint64_t overruns) const;

 private:
  struct Moment {
    Time time;
    std::uint64_t ticks;
    std::uint64_t overruns;
  };
  double rate_hz_;
  Moment begin_{};
  std::deque<Moment> moments_;  // of the last second, and the one before them
};

}  // namespace haptrial::experiments
