#pragma once

#include <time.h>

#include <atomic>
#include <cstdint>

namespace haptrial::device {

/// Counts the calls into a vendor's library that took longer than a bound. Nothing interrupts such
/// a call; it shows as an overrun of the loop, and here as its cause.
class CallTimer {
 public:
  /// @param bound  [s]
  explicit CallTimer(double bound) noexcept : bound_ns_(static_cast<std::int64_t>(bound * 1e9)) {}

  /// Any thread.
  std::uint64_t slow() const noexcept { return slow_.load(std::memory_order_relaxed); }

  /// Measures from its construction to its end. Servo thread.
  class Scope {
   public:
    explicit Scope(CallTimer& timer) noexcept : timer_(timer), start_(now()) {}
    ~Scope() {
      if (now() - start_ > timer_.bound_ns_) {
        timer_.slow_.fetch_add(1, std::memory_order_relaxed);
      }
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    CallTimer& timer_;
    std::int64_t start_;  // [ns]
  };

 private:
  static std::int64_t now() noexcept {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
  }

  std::int64_t bound_ns_;
  std::atomic<std::uint64_t> slow_{0};
};

}  // namespace haptrial::device
