#pragma once

#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <cstdint>

#include "core/markers/onset.h"
#include "core/realtime/block_log.h"

namespace haptrial::markers {

/// Carries onsets from the servo thread to the one thread that sends them, and wakes it.
class OnsetLog {
 public:
  OnsetLog();
  ~OnsetLog();
  OnsetLog(const OnsetLog&) = delete;
  OnsetLog& operator=(const OnsetLog&) = delete;

  /// Numbers the onset, keeps it and wakes who waits. Servo thread: no allocation, lock, wait, I/O
  /// or throw (MarkedTaskTest.TheTickAllocatesNothing).
  void put(TimedOnset onset) noexcept;

  /// Onsets so far, without ends of passes. Any thread.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// How many onsets of both kinds the log had no room for. Any thread.
  std::uint64_t put_so_far() const noexcept { return log_.pushed(); }
  std::uint64_t dropped() const noexcept { return log_.dropped(); }

  /// Waits until something was put, wake() was called, or it is that late. The sending thread.
  void wait_until(std::chrono::steady_clock::time_point end) noexcept;
  void wake() noexcept;  // any thread
  /// Hands over what came, in order. @returns how many. The sending thread.
  template <class F>
  std::size_t take(F&& f) {
    return log_.flush([&f](std::span<const TimedOnset> onsets) {
      for (const TimedOnset& onset : onsets) {
        f(onset);
      }
    });
  }

 private:
  realtime::BlockLog<TimedOnset> log_{64, 16};
  std::atomic<std::uint64_t> count_{0};
  sem_t wake_{};
};

}  // namespace haptrial::markers
