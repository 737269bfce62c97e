#include "experiments/screen/frame_pacing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

TEST(PaceTest, TheDisplaySetsThePaceIfItKeepsToItsMonitor) {
  const AgreedPace kept = agreed_pace(true, 120.0, 1.1 / 120.0, 60.0);
  EXPECT_TRUE(kept.refresh_locked);
  EXPECT_EQ(kept.rate, 120.0);
  EXPECT_EQ(kept.notice, "");
  const AgreedPace faster = agreed_pace(true, 120.0, 0.001, 60.0);
  EXPECT_FALSE(faster.refresh_locked);
  EXPECT_EQ(faster.rate, 120.0);
  EXPECT_THAT(faster.notice, HasSubstr("does not wait"));
  const AgreedPace unknown = agreed_pace(true, 0.0, 0.016, 60.0);
  EXPECT_FALSE(unknown.refresh_locked);
  EXPECT_EQ(unknown.rate, 60.0);
  EXPECT_THAT(agreed_pace(false, 60.0, 1.0 / 60.0, 60.0).notice, HasSubstr("no refresh lock"));
}

/// A picture on a simulated clock: waited for, and shown after `work_ns`.
record::FrameRow picture(Pace& pace, std::int64_t& now_ns, std::int64_t work_ns) {
  now_ns = pace.next_due(now_ns) + work_ns;
  return pace.shown(0, now_ns);
}

// Pictures and those that were missed add up to the time that went by.
TEST(PaceTest, ATimerCountsWhatItMisses) {
  constexpr std::int64_t kPeriod = 2'000'000;  // [ns]
  std::int64_t now = 5'000'000'000;
  const std::int64_t start = now;
  Pace pace({500.0, false, ""}, start);
  std::int64_t periods = 0;
  for (int i = 0; i < 30; ++i) {
    const record::FrameRow row = picture(pace, now, i == 10 ? 21'000'000 : 100'000);
    EXPECT_EQ(row.time_ns, now);
    EXPECT_EQ(row.dropped, i == 11 ? 9 : 0) << i;
    periods += 1 + row.dropped;
  }
  EXPECT_EQ(periods, (now - start) / kPeriod);
}

// A picture that takes a period and a half comes after that, not after two periods.
TEST(PaceTest, ATimerDoesNotWaitWhereAPictureIsLate) {
  constexpr std::int64_t kWork = 15'000'000;  // [ns]
  std::int64_t now = 0;
  Pace pace({100.0, false, ""}, now);
  std::int32_t dropped = picture(pace, now, kWork).dropped;
  for (int i = 1; i < 20; ++i) {
    const std::int64_t before = now;
    dropped += picture(pace, now, kWork).dropped;
    EXPECT_EQ(now - before, kWork) << i;
  }
  EXPECT_EQ(dropped, 9);
}

// If the swap waits for the refresh, the distance of two pictures tells how many had none.
TEST(PaceTest, RefreshesWithoutAPictureAreCounted) {
  std::int64_t now = 0;
  Pace pace({100.0, true, ""}, now);
  EXPECT_EQ(picture(pace, now, 10'000'000).dropped, 0);
  EXPECT_EQ(picture(pace, now, 35'000'000).dropped, 3);
}

}  // namespace
}  // namespace haptrial::experiments
