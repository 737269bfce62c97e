#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace haptrial::test {

/// Every force that a stand-in library was given, with its time, in the file that STAND_IN_FORCES
/// names. The file is mapped, so that it holds all of them however the program dies.
class ForceRecord {
 public:
  struct Head {
    std::int64_t count;
    double watchdog;  // without a command for so long the motors go off [s]
  };
  struct Row {
    std::int64_t time_ns;         // CLOCK_MONOTONIC
    std::array<double, 3> force;  // commanded [N]
  };
  static constexpr std::size_t kMost = 400'000;

  ForceRecord() {
    const char* const file = std::getenv("STAND_IN_FORCES");
    if (file == nullptr) {
      return;
    }
    constexpr std::size_t kSize = sizeof(Head) + kMost * sizeof(Row);
    const int opened = ::open(file, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (opened >= 0 && ::ftruncate(opened, kSize) == 0) {
      void* const mapped = ::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
      head_ = mapped == MAP_FAILED ? nullptr : static_cast<Head*>(mapped);
    }
    ::close(opened);
  }

  void add(const std::array<double, 3>& force, double watchdog) {
    if (head_ == nullptr) {
      return;
    }
    std::atomic_ref<std::int64_t> count(head_->count);
    const std::int64_t row = count.load();
    if (row >= static_cast<std::int64_t>(kMost)) {
      return;
    }
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    head_->watchdog = watchdog;
    reinterpret_cast<Row*>(head_ + 1)[row] = {now.tv_sec * 1'000'000'000 + now.tv_nsec, force};
    count.store(row + 1);
  }

 private:
  Head* head_{nullptr};
};

/// Orders of a stand-in in its environment, for tests of another program: the failure of number
/// STAND_IN_FAILURE comes 50 ticks after the force has first reached STAND_IN_FAILURE_FORCE
/// newtons.
class FailureFromEnvironment {
 public:
  /// @returns whether the failure begins with this force.
  bool begins(double force) {
    static const char* const at = std::getenv("STAND_IN_FAILURE_FORCE");
    if (at == nullptr || begun_ || (reached_ == 0 && force < std::atof(at))) {
      return false;
    }
    constexpr int kTicks = 50;
    begun_ = ++reached_ > kTicks;
    return begun_;
  }
  static int number() {
    const char* const asked = std::getenv("STAND_IN_FAILURE");
    return asked == nullptr ? 0 : std::atoi(asked);
  }

 private:
  int reached_{0};
  bool begun_{false};
};

}  // namespace haptrial::test
