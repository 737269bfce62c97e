#include "experiments/runner/loop_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace haptrial::experiments {
namespace {

using std::chrono::milliseconds;

/// Tells the watch of a loop every 5 ms.
class LoopWatchTest : public testing::Test {
 protected:
  /// @returns how many of the calls said that the loop is overloaded.
  int pass(milliseconds time, double ticks_a_ms, double overruns_a_tick) {
    int said = 0;
    constexpr milliseconds kStep{5};
    for (milliseconds t{0}; t < time; t += kStep) {
      now_ += kStep;
      ticks_ += 5.0 * ticks_a_ms;
      overruns_ += 5.0 * ticks_a_ms * overruns_a_tick;
      sentence_ = watch_.overloaded(now_, static_cast<std::uint64_t>(ticks_),
                                    static_cast<std::uint64_t>(overruns_));
      said += sentence_ ? 1 : 0;
    }
    return said;
  }
  LoopWatch watch_{1000.0};
  LoopWatch::Time now_{};
  double ticks_{0.0};
  double overruns_{0.0};
  std::optional<std::string> sentence_;
};

TEST_F(LoopWatchTest, ALibraryOfFiveMillisecondsACallIsOverloadWithinASecond) {
  watch_.begin_pass(0, 0);
  EXPECT_EQ(pass(milliseconds(1000), 0.1, 0.85), 0) << "not before a whole second was seen";
  EXPECT_GT(pass(milliseconds(20), 0.1, 0.85), 0);
  EXPECT_THAT(sentence_.value_or(""),
              testing::HasSubstr("overloaded: 100 of 1000 ticks a second, 85 % of them"));
}

TEST_F(LoopWatchTest, ADelayThatIsCaughtUpWithIsNone) {
  pass(milliseconds(2000), 1.0, 0.0);
  EXPECT_EQ(pass(milliseconds(95), 0.0, 0.0), 0);
  EXPECT_EQ(pass(milliseconds(190), 1.5, 1.0), 0);
  EXPECT_EQ(pass(milliseconds(2000), 1.0, 0.0), 0);
}

TEST_F(LoopWatchTest, ASuspensionIsNone) {
  pass(milliseconds(2000), 1.0, 0.0);
  EXPECT_EQ(pass(milliseconds(3000), 0.0, 0.0), 0);
  EXPECT_EQ(pass(milliseconds(3000), 1.0, 0.001), 0);
}

TEST_F(LoopWatchTest, APassWithMoreThanOneInAHundredIsTold) {
  watch_.begin_pass(1000, 500);
  EXPECT_EQ(watch_.end_pass(2000, 510), std::nullopt);
  EXPECT_EQ(watch_.end_pass(2000, 511), "11 of 1000 ticks (1.1 %) overran their period");
}

}  // namespace
}  // namespace haptrial::experiments
