#pragma once

#include <atomic>
#include <cstdint>

#include "core/realtime/deadlines.h"
#include "core/realtime/histogram.h"
#include "core/realtime/real_time.h"

namespace haptrial::realtime {

enum class ClockKind { kReal, kSimulated };

/// One pass of the servo loop.
struct Tick {
  std::uint64_t index;   // from 0, without gaps, also over several calls of run()
  std::int64_t time_ns;  // start of this tick since the first tick of the loop [ns]
  double dt;             // the nominal period 1 / rate [s]; what really passed is in time_ns
  std::int64_t suspended_ns{0};  // for which the loop stood still before this tick; no tick makes
                                 // up for it
};

/// The task of a servo loop once a period.
class ServoTask {
 public:
  virtual ~ServoTask() = default;
  /// Servo thread: must not allocate, lock, wait, touch a file or throw.
  /// @returns false to leave run() after this tick.
  virtual bool tick(const Tick& tick) noexcept = 0;
};

/// How a real loop kept time. All empty under the simulated clock, which takes no time.
struct LoopTiming {
  DurationHistogram period;    // start to start of ticks that follow one another in one run()
  DurationHistogram lateness;  // start of a tick after its deadline
  DurationHistogram compute;   // start to end of a tick
};

/// Calls a task at a fixed rate, on the real clock or on a simulated one.
///
/// Simulated: tick i happens at exactly i / rate, rounded to a nanosecond; the loop never waits.
///
/// Real: tick i of a run() is due i periods after its first, on CLOCK_MONOTONIC, so that delays do
/// not add up. No tick is left out: after a delay the ticks that are due come at twice the rate
/// until the loop has caught up, and N periods hold N ticks. They do not come in one burst because
/// a target that moves with the tick index would then jump, and the force with it; at twice the
/// rate it moves at no more than twice its speed. A loop that is more than 100 ms (or one period,
/// if that is longer) behind was suspended: there the deadlines move to the present, and the event
/// is counted in resynchronised().
///
/// Source: Morris 2006, §6.4.1 (the rate and the separate thread).
class ServoLoop {
 public:
  /// @param rate_hz  above 0, at most 1e6 [Hz]
  /// @throws std::invalid_argument for another rate.
  ServoLoop(ClockKind clock, double rate_hz);

  /// Ticks until the task returns false or a stop is requested. A real loop asks for real-time
  /// treatment of the calling thread while it runs (real_time_status()).
  void run(ServoTask& task);

  /// Makes run() return before its next tick, and later ones at once, until clear_stop(). Any
  /// thread, or a signal handler. A real loop notices at its next deadline.
  void request_stop() noexcept { stop_.store(true, std::memory_order_relaxed); }
  void clear_stop() noexcept { stop_.store(false, std::memory_order_relaxed); }
  bool stop_requested() const noexcept { return stop_.load(std::memory_order_relaxed); }

  ClockKind clock() const noexcept { return clock_; }
  double rate_hz() const noexcept { return rate_hz_; }

  /// Whether a real loop has begun its first tick; real_time_status() is there from then on. Any
  /// thread.
  bool started() const noexcept { return origin_ns_.load(std::memory_order_acquire) >= 0; }
  /// The time now on the clock of Tick::time_ns, also after a suspension; 0 before the first tick.
  /// Simulated: when the next tick will be. Any thread [ns]
  std::int64_t elapsed_ns() const noexcept;

  /// Any thread, also while the loop runs.
  std::uint64_t ticks() const noexcept { return ticks_.load(std::memory_order_relaxed); }
  /// Ticks that ended after the deadline of the next one, through their own work or a late start.
  std::uint64_t overruns() const noexcept { return overruns_.load(std::memory_order_relaxed); }
  std::uint64_t resynchronised() const noexcept {
    return resynchronised_.load(std::memory_order_relaxed);
  }

  /// Timing of the loop, after run() has returned, or on its thread; the status also once
  /// started().
  const LoopTiming& timing() const noexcept { return timing_; }
  const RealTimeStatus& real_time_status() const noexcept { return status_; }

 private:
  void run_simulated(ServoTask& task);
  void run_real(ServoTask& task);
  void note_start(const Deadlines::Start& start) noexcept;

  ClockKind clock_;
  double rate_hz_;
  double period_ns_;
  std::atomic<std::int64_t> origin_ns_{-1};  // start of the first tick on CLOCK_MONOTONIC
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::uint64_t> overruns_{0};
  std::atomic<std::uint64_t> resynchronised_{0};
  LoopTiming timing_;
  RealTimeStatus status_;
};

}  // namespace haptrial::realtime
