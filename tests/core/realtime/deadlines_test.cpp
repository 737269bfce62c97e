#include "core/realtime/deadlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace haptrial::realtime {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// Runs ticks on a clock of its own: each starts when it should and takes `work`.
struct Clockwork {
  explicit Clockwork(double period_ns) : deadlines(period_ns, 0) {}
  Deadlines::Start tick(std::int64_t work) {
    now = std::max(now, deadlines.wake());
    starts.push_back(now);
    const auto start = deadlines.start(now);
    now += work;
    overruns += deadlines.end(now);
    return start;
  }
  Deadlines deadlines;
  std::int64_t now{0};
  std::vector<std::int64_t> starts;
  int overruns{0};
};

TEST(DeadlinesTest, TicksAreDueAtMultiplesOfThePeriodWithoutDrift) {
  const double period = 1e9 / 3000;  // no whole number of nanoseconds
  Clockwork clock(period);
  for (int i = 0; i < 300000; ++i) {
    EXPECT_EQ(clock.tick(1000).lateness, 0);
  }
  for (int i = 0; i < 300000; ++i) {
    ASSERT_LE(std::abs(static_cast<double>(clock.starts[i]) - i * period), 0.5001) << i;
  }
  EXPECT_EQ(clock.starts[3000 * 99], 99'000 * kMs);
  EXPECT_EQ(clock.overruns, 0);
}

TEST(DeadlinesTest, AfterAShortDelayTicksComeAtTwiceTheRateUntilOnTime) {
  Clockwork clock(1e6);
  clock.tick(0);
  clock.tick(3 * kMs);  // starts at 1 ms, ends at 4 ms, when tick 4 is due
  std::vector<std::int64_t> lateness;
  for (int i = 2; i < 9; ++i) {
    lateness.push_back(clock.tick(0).lateness);
  }
  EXPECT_EQ(clock.starts, (std::vector<std::int64_t>{0, 1000000, 4000000, 4500000, 5000000, 5500000,
                                                     6000000, 7000000, 8000000}));
  EXPECT_EQ(lateness, (std::vector<std::int64_t>{2 * kMs, 3 * kMs / 2, kMs, kMs / 2, 0, 0, 0}));
}

TEST(DeadlinesTest, OverrunIsATickThatEndsAfterTheNextDeadline) {
  Clockwork clock(1e6);
  clock.tick(kMs);  // to the nanosecond in time
  EXPECT_EQ(clock.overruns, 0);
  clock.tick(kMs + 1);
  EXPECT_EQ(clock.overruns, 1);
  for (int i = 0; i < 5; ++i) {
    clock.tick(kMs / 4);
  }
  EXPECT_EQ(clock.overruns, 1);
}

TEST(DeadlinesTest, HundredMillisecondsAreCaughtUpAndMoreMovesTheDeadlines) {
  Clockwork clock(1e6);
  clock.tick(101 * kMs);
  EXPECT_FALSE(clock.tick(0).resynchronised);  // exactly 100 ms late
  // Half a period is won back each tick: tick i starts at 101 + (i - 1) / 2 ms, i = 201 on time.
  for (int i = 2; i <= 201; ++i) {
    EXPECT_FALSE(clock.tick(0).resynchronised);
  }
  EXPECT_EQ(clock.starts.back(), 201 * kMs);
  EXPECT_EQ(clock.tick(102 * kMs).lateness, 0);  // so that the next is 101 ms late
  const auto late = clock.tick(0);
  EXPECT_TRUE(late.resynchronised);
  EXPECT_EQ(late.lateness, 101 * kMs);
  const std::int64_t anchor = clock.starts.back();
  const auto next = clock.tick(0);
  EXPECT_EQ(next.lateness, 0);
  EXPECT_EQ(clock.starts.back(), anchor + kMs);
}

TEST(DeadlinesTest, ASlowLoopIsNotHopelessWithinItsPeriod) {
  Clockwork clock(1e9);
  clock.tick(1'500 * kMs);
  EXPECT_FALSE(clock.tick(0).resynchronised);
  EXPECT_EQ(clock.tick(0).lateness, 0);
}

TEST(DeadlinesTest, PeriodIsTheTimeFromStartToStart) {
  Clockwork clock(1e6);
  EXPECT_FALSE(clock.tick(0).period);
  EXPECT_EQ(clock.tick(2 * kMs).period, kMs);
  EXPECT_EQ(clock.tick(0).period, 2 * kMs);
  EXPECT_EQ(clock.tick(0).period, kMs / 2);
}

}  // namespace
}  // namespace haptrial::realtime
