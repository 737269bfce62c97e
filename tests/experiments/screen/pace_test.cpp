#include "experiments/screen/pace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

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

// Pictures and those that were missed add up to the time that went by.
TEST(PaceTest, ATimerCountsWhatItMisses) {
  constexpr double kRate = 500.0;
  Pace pace({kRate, false, ""});
  const std::int64_t start = screen_ns();
  std::int64_t periods = 0;
  std::int64_t last = start;
  for (int picture = 0; picture < 30; ++picture) {
    pace.wait();
    if (picture == 10) {
      std::this_thread::sleep_for(std::chrono::milliseconds(21));
    }
    const record::FrameRow row = pace.shown(0);
    periods += 1 + row.dropped;
    EXPECT_GE(row.time_ns, last);
    last = row.time_ns;
  }
  const double passed = 1e-9 * static_cast<double>(last - start) * kRate;
  EXPECT_GE(periods, 30 + 9) << "21 ms are ten periods";
  EXPECT_NEAR(static_cast<double>(periods), passed, 12.0) << "the last picture may itself be late";
  EXPECT_LE(static_cast<double>(periods), passed + 1.0);
}

// A picture that takes a period and a half comes after that, not after two periods.
TEST(PaceTest, ATimerDoesNotWaitWhereAPictureIsLate) {
  constexpr double kRate = 100.0;
  Pace pace({kRate, false, ""});
  std::int32_t dropped = 0;
  double waited = 0.0;
  constexpr int kPictures = 20;
  for (int picture = 0; picture < kPictures; ++picture) {
    const std::int64_t before = screen_ns();
    pace.wait();
    waited += picture > 0 ? 1e-9 * static_cast<double>(screen_ns() - before) : 0.0;
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
    dropped += pace.shown(0).dropped;
  }
  EXPECT_LT(waited, 0.5 * kPictures * 0.005) << "a step of the timer would take 5 ms each";
  EXPECT_GE(dropped, kPictures / 2 - 2);
}

// Where the swap waits for the refresh, the distance of two pictures tells how many had none.
TEST(PaceTest, RefreshesWithoutAPictureAreCounted) {
  Pace pace({100.0, true, ""});
  pace.wait();
  pace.shown(0);
  std::this_thread::sleep_for(std::chrono::milliseconds(35));
  EXPECT_GE(pace.shown(0).dropped, 2);
}

}  // namespace
}  // namespace haptrial::experiments
