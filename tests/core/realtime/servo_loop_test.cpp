#include "core/realtime/servo_loop.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace haptrial::realtime {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void work_for(double seconds) {
  for (const auto start = Clock::now(); seconds_since(start) < seconds;) {
  }
}

// Notes every tick and leaves the loop after `count` of them.
struct Recorder : ServoTask {
  explicit Recorder(std::size_t n) : count(n) { ticks.reserve(n); }
  bool tick(const Tick& tick) noexcept override {
    ticks.push_back(tick);
    if (inside) {
      inside(tick);
    }
    return ticks.size() < count;
  }
  std::size_t count;
  std::vector<Tick> ticks;
  std::function<void(const Tick&)> inside;
};

TEST(ServoLoopTest, RejectsARateThatIsNone) {
  for (const double rate :
       {0.0, -1000.0, 1e7, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(ServoLoop(ClockKind::kSimulated, rate), std::invalid_argument) << rate;
  }
}

TEST(ServoLoopTest, SimulatedTicksAreExactMultiplesOfThePeriod) {
  ServoLoop loop(ClockKind::kSimulated, 1000);
  Recorder task(100000);
  loop.run(task);
  ASSERT_EQ(task.ticks.size(), 100000u);
  for (std::uint64_t i = 0; i < task.ticks.size(); ++i) {
    ASSERT_EQ(task.ticks[i].index, i);
    ASSERT_EQ(task.ticks[i].time_ns, static_cast<std::int64_t>(i) * 1'000'000);
    ASSERT_EQ(task.ticks[i].dt, 1e-3);
  }
}

TEST(ServoLoopTest, SimulatedPeriodsThatAreNoWholeNanosecondsDoNotDrift) {
  ServoLoop loop(ClockKind::kSimulated, 3000);
  Recorder task(300001);
  loop.run(task);
  for (std::int64_t i = 0; i <= 300000; ++i) {
    // Rounded quotient in whole numbers.
    ASSERT_EQ(task.ticks[static_cast<std::size_t>(i)].time_ns, (i * 2'000'000'000 + 3000) / 6000);
  }
}

TEST(ServoLoopTest, SimulatedIndexGoesOnOverRuns) {
  ServoLoop loop(ClockKind::kSimulated, 500);
  Recorder first(10), second(5);
  loop.run(first);
  loop.run(second);
  EXPECT_EQ(second.ticks.front().index, 10u);
  EXPECT_EQ(second.ticks.front().time_ns, 20'000'000);
  EXPECT_EQ(loop.ticks(), 15u);
}

TEST(ServoLoopTest, SimulatedReportsNoTimingAndDoesNotWait) {
  ServoLoop loop(ClockKind::kSimulated, 1000);
  Recorder task(1'200'000);  // twenty minutes, for which no test could wait
  loop.run(task);
  EXPECT_EQ(loop.timing().period.count(), 0u);
  EXPECT_EQ(loop.timing().lateness.count(), 0u);
  EXPECT_EQ(loop.timing().compute.count(), 0u);
  EXPECT_EQ(loop.overruns(), 0u);
  EXPECT_FALSE(loop.real_time_status().fifo);
}

TEST(ServoLoopTest, SimulatedRunDoesNotAllocate) {
  ServoLoop loop(ClockKind::kSimulated, 1000);
  Recorder task(1000);
  const test::AllocationGuard guard;
  loop.run(task);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(ServoLoopTest, StopHoldsUntilCleared) {
  ServoLoop loop(ClockKind::kSimulated, 1000);
  Recorder task(100);
  task.inside = [&](const Tick& tick) {
    if (tick.index == 41) {
      loop.request_stop();
    }
  };
  loop.run(task);
  EXPECT_EQ(task.ticks.size(), 42u);
  loop.run(task);
  EXPECT_EQ(task.ticks.size(), 42u);
  EXPECT_TRUE(loop.stop_requested());
  loop.clear_stop();
  loop.run(task);
  EXPECT_EQ(task.ticks.size(), 100u);
  EXPECT_EQ(task.ticks.back().index, 99u);
}

TEST(ServoLoopTest, RealClockGivesOneTickAPeriod) {
  ServoLoop loop(ClockKind::kReal, 1000);
  struct : ServoTask {
    bool tick(const Tick& t) noexcept override {
      gap = gap || t.index != ticks;
      backwards = backwards || t.time_ns < last_ns;
      ++ticks;
      last_ns = t.time_ns;
      return t.time_ns < 2'000'000'000;
    }
    std::uint64_t ticks{0};
    std::int64_t last_ns{0};
    bool gap{false}, backwards{false};
  } task;
  const auto start = Clock::now();
  loop.run(task);
  const double elapsed = seconds_since(start);
  EXPECT_FALSE(task.gap);
  EXPECT_FALSE(task.backwards);
  if (loop.resynchronised() == 0) {
    // 2000 periods lie between the first tick and the first at or after 2 s; a late start of either
    // moves the count by as many periods as it was late.
    EXPECT_NEAR(static_cast<double>(loop.ticks()), 2001.0,
                std::ceil(loop.timing().lateness.max() / 1e6));
  }
  EXPECT_GE(elapsed, 2.0);
  EXPECT_EQ(loop.ticks(), task.ticks);
  EXPECT_EQ(loop.timing().lateness.count(), loop.ticks());
  EXPECT_EQ(loop.timing().compute.count(), loop.ticks());
  EXPECT_EQ(loop.timing().period.count(), loop.ticks() - 1);
  EXPECT_NEAR(loop.timing().period.mean() * static_cast<double>(loop.ticks() - 1),
              static_cast<double>(task.last_ns), 1e3);
}

TEST(ServoLoopTest, TwoThousandRealTicksTakeTwoSeconds) {
  ServoLoop loop(ClockKind::kReal, 1000);
  Recorder task(2000);
  loop.run(task);
  EXPECT_EQ(task.ticks.size(), 2000u);
  if (loop.resynchronised() == 0) {
    EXPECT_NEAR(static_cast<double>(task.ticks.back().time_ns), 1999e6,
                loop.timing().lateness.max());
  }
}

TEST(ServoLoopTest, ATickThatTakesTooLongIsCountedAndCaughtUp) {
  ServoLoop loop(ClockKind::kReal, 1000);
  Recorder task(300);
  task.inside = [](const Tick& tick) {
    if (tick.index == 20) {
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
  };
  loop.run(task);
  EXPECT_GE(loop.overruns(), 3u);  // itself, and the late ones that it held up
  EXPECT_GE(loop.timing().compute.max(), 3e6);
  EXPECT_GE(loop.timing().lateness.max(), 2e6);
  for (std::size_t i = 1; i < task.ticks.size(); ++i) {  // no burst
    EXPECT_GE(task.ticks[i].time_ns - task.ticks[i - 1].time_ns, 500'000) << i;
  }
}

TEST(ServoLoopTest, ASuspendedLoopMovesItsDeadlines) {
  ServoLoop loop(ClockKind::kReal, 1000);
  Recorder task(100);
  task.inside = [](const Tick& tick) {
    if (tick.index == 20) {
      work_for(0.15);
    }
  };
  loop.run(task);
  EXPECT_GE(loop.resynchronised(), 1u);
  EXPECT_EQ(task.ticks.size(), 100u);
  EXPECT_GE(task.ticks[21].time_ns, task.ticks[20].time_ns + 150'000'000);
  EXPECT_GE(task.ticks[21].suspended_ns, 149'000'000);
  std::int64_t suspended = 0;
  for (const Tick& tick : task.ticks) {  // the clock is the ticks, and what they do not make up for
    suspended += tick.suspended_ns;
    const auto periods = static_cast<std::int64_t>(tick.index) * 1'000'000;
    EXPECT_LE(std::abs(tick.time_ns - periods - suspended), 100'000'000) << tick.index;
  }
  // The 78 periods from there to the last tick are whole: nothing is caught up.
  EXPECT_GE(task.ticks.back().time_ns, task.ticks[21].time_ns + 78 * 1'000'000);
}

TEST(ServoLoopTest, TheTimeOfTheLoopIsThatOfItsTicksAlsoAfterASuspension) {
  ServoLoop loop(ClockKind::kReal, 1000);
  EXPECT_FALSE(loop.started());
  EXPECT_EQ(loop.elapsed_ns(), 0);
  Recorder task(60);
  std::vector<std::int64_t> elapsed(60);
  task.inside = [&](const Tick& tick) {
    if (tick.index == 20) {
      work_for(0.15);
    }
    elapsed[tick.index] = loop.elapsed_ns();
  };
  loop.run(task);
  EXPECT_TRUE(loop.started());
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_GE(elapsed[i], task.ticks[i].time_ns) << i;
    if (i + 1 < 60) {
      EXPECT_LE(elapsed[i], task.ticks[i + 1].time_ns) << i;
    }
  }
  EXPECT_GE(loop.elapsed_ns(), 200'000'000) << "20 ticks, 150 ms and 40 ticks";
}

TEST(ServoLoopTest, TheTimeOfASimulatedLoopIsThatOfItsNextTick) {
  ServoLoop loop(ClockKind::kSimulated, 1000);
  Recorder task(250);
  loop.run(task);
  EXPECT_EQ(loop.elapsed_ns(), 250'000'000);
}

TEST(ServoLoopTest, RealIndexAndTimeGoOnOverRunsAndThePauseIsNoPeriod) {
  ServoLoop loop(ClockKind::kReal, 1000);
  Recorder first(20), second(20);
  loop.run(first);
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  loop.run(second);
  EXPECT_EQ(second.ticks.front().index, 20u);
  EXPECT_GE(second.ticks.front().time_ns, first.ticks.back().time_ns + 150'000'000);
  EXPECT_EQ(loop.timing().period.count(), 38u);
  EXPECT_EQ(loop.timing().lateness.count(), 40u);
}

TEST(ServoLoopTest, AnotherThreadStopsARealLoop) {
  ServoLoop loop(ClockKind::kReal, 1000);
  struct : ServoTask {
    bool tick(const Tick&) noexcept override { return true; }
  } forever;
  std::thread servo([&] { loop.run(forever); });
  while (loop.ticks() < 50) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  loop.request_stop();
  servo.join();
  EXPECT_EQ(loop.timing().compute.count(), loop.ticks());
}

TEST(ServoLoopTest, RealTicksDoNotAllocate) {
  ServoLoop loop(ClockKind::kReal, 1000);
  struct : ServoTask {
    bool tick(const Tick& tick) noexcept override {
      (tick.index == 0 ? first : last) = guard.count();
      return tick.index < 200;
    }
    test::AllocationGuard guard;
    std::size_t first{0}, last{0};
  } task;
  loop.run(task);
  EXPECT_EQ(task.last, task.first);
}

TEST(ServoLoopTest, SchedulingIsGivenBackAndRefusalsAreExplained) {
  int before = -1, inside = -1, after = -1;
  const auto policy = [](int& p) {
    sched_param param;
    pthread_getschedparam(pthread_self(), &p, &param);
    p &= ~SCHED_RESET_ON_FORK;
  };
  ServoLoop loop(ClockKind::kReal, 1000);
  Recorder task(3);
  task.inside = [&](const Tick&) { policy(inside); };
  policy(before);
  loop.run(task);
  policy(after);
  EXPECT_EQ(after, before);
  const RealTimeStatus& status = loop.real_time_status();
  EXPECT_EQ(inside, status.fifo ? SCHED_FIFO : before);
  EXPECT_EQ(status.notice.find("CAP_SYS_NICE") == std::string::npos, status.fifo);
  EXPECT_EQ(status.notice.find("CAP_IPC_LOCK") == std::string::npos, status.memory_locked);
  EXPECT_EQ(status.notice.empty(), status.fifo && status.memory_locked);
}

}  // namespace
}  // namespace haptrial::realtime
