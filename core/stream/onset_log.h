#pragma once

#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <cstdint>

#include "core/realtime/block_log.h"
#include "core/stream/onset.h"

namespace haptrial::markers {

/// Carries onsets from the servo thread to the one thread that sends them, and wakes it. Whole
/// ticks at a time, since the codes of a tick are sent in an order of their own.
class OnsetLog {
 public:
  OnsetLog();
  ~OnsetLog();
  OnsetLog(const OnsetLog&) = delete;
  OnsetLog& operator=(const OnsetLog&) = delete;

  /// Numbers the onsets of a tick, keeps them and wakes who waits; nothing when there are none.
  /// Servo thread: no allocation, lock, wait, I/O or throw
  /// (MarkedTaskTest.TheTickAllocatesNothing).
  void put(TickOnsets onsets) noexcept;

  /// Onsets so far, without ends of passes. Any thread.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// How many ticks were put, and how many more the log had no room for. Any thread.
  std::uint64_t put_so_far() const noexcept { return log_.pushed(); }
  std::uint64_t dropped() const noexcept { return log_.dropped(); }

  /// Waits until something was put, wake() was called, or it is that late. The sending thread.
  void wait_until(std::chrono::steady_clock::time_point end) noexcept;
  void wake() noexcept;  // any thread
  /// Hands over every onset that came, in order. @returns of how many ticks. The sending thread.
  template <class F>
  std::size_t take(F&& f) {
    return log_.flush([&f](std::span<const TickOnsets> ticks) {
      for (const TickOnsets& tick : ticks) {
        for (const TimedOnset& onset : tick.all()) {
          f(onset);
        }
      }
    });
  }

 private:
  realtime::BlockLog<TickOnsets> log_{64, 16};
  std::atomic<std::uint64_t> count_{0};
  sem_t wake_{};
};

}  // namespace haptrial::markers
