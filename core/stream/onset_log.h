#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/realtime/block_log.h"
#include "core/record/rows/marker_row.h"

namespace haptrial::markers {

/// Something of a trial begins on a tick. Plain data.
struct Onset {
  record::MarkerOf what{record::MarkerOf::kTrial};
  std::int16_t index{0};     // which interval of the definition, stage or answer, from 0
  std::int16_t interval{0};  // its place in the pass, from 1; 0: none
  std::int16_t sound{-1};    // of the definition's sounds, begins with it; -1: none
};

/// The onsets of one tick. Servo thread: no allocation, lock or throw.
class Onsets {
 public:
  static constexpr std::size_t kMost = 4;

  /// One too many is left out.
  void add(const Onset& onset) noexcept {
    if (count_ < kMost) {
      all_[count_++] = onset;
    }
  }
  std::span<const Onset> all() const noexcept { return {all_.data(), count_}; }

 private:
  std::array<Onset, kMost> all_{};
  std::size_t count_{0};
};

/// An onset with its place in the session.
struct TimedOnset {
  Onset onset;
  std::uint64_t number{0};    // of the run, from 1
  std::uint64_t sequence{0};  // of the tick
  std::int64_t time_ns{0};    // of the tick, since the session's first one
  std::int32_t pass{-1};      // row of /trials
  bool over{false};           // no onset: the pass has ended
};

/// Onsets of one tick, to be handed over at once. Servo thread: no allocation, lock or throw.
class TickOnsets {
 public:
  static constexpr std::size_t kMost = Onsets::kMost + 2;  // and the trial, and its first stage

  /// One too many is left out.
  void add(const TimedOnset& onset) noexcept {
    if (count_ < kMost) {
      all_[count_++] = onset;
    }
  }
  std::span<TimedOnset> all() noexcept { return {all_.data(), count_}; }
  std::span<const TimedOnset> all() const noexcept { return {all_.data(), count_}; }

 private:
  std::array<TimedOnset, kMost> all_{};
  std::size_t count_{0};
};

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
