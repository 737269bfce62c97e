#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "experiments/runner/loop_pacing.h"
#include "experiments/runner/servo_thread.h"
#include "tests/support/message_of.h"
#include "tests/support/scripted_device.h"
#include "tests/support/wait.h"

namespace haptrial::experiments {
namespace {

using protocols::SessionTask;

/// A force for as long as it is asked.
class HoldingPass final : public protocols::Pass {
 public:
  protocols::PassOutput tick(const protocols::Readings&, double) noexcept override {
    protocols::PassOutput out;
    out.force = {0.0, 4.0, 0.0};
    return out;
  }
  protocols::PassState state() const noexcept override { return protocols::PassState::kRunning; }
};

/// Parts that a servo thread uses; on the heap, so that a thread that hangs keeps them.
struct Parts {
  static device::EnvelopeLimits limits() {
    device::EnvelopeLimits l;
    l.ramp_in = 0.0;
    l.ramp_out = 0.1;
    return l;
  }
  test::ScriptedDevice device;
  SessionTask::Log log{1 << 16, 2};
  SessionTask task{device, limits(), log, {}, SessionTask::Leave::kNever};
  realtime::ServoLoop loop{realtime::ClockKind::kReal, 1000.0};
  HoldingPass pass;
  std::atomic<bool> hang{false};

  void run_until(std::uint64_t ticks) const {
    test::wait_until([&] { return loop.ticks() >= ticks; });
  }
};

TEST(ServoThreadTest, EndsWhenTheForceHasFaded) {
  auto parts = std::make_unique<Parts>();
  ServoThread servo(parts->loop, parts->task, longest_fade(Parts::limits()));
  parts->task.start(parts->pass, 0);
  servo.start();
  parts->run_until(100);
  parts->task.break_off();
  servo.end();
  EXPECT_FALSE(servo.runs());
  const auto& forces = parts->device.written;
  ASSERT_GT(forces.size(), 100u);
  EXPECT_TRUE(forces.back().isZero(0.0));
  double largest_step = 0.0;
  for (std::size_t i = 50; i < forces.size(); ++i) {
    largest_step = std::max(largest_step, (forces[i] - forces[i - 1]).norm());
  }
  EXPECT_LT(largest_step, 0.05) << "4 N over 100 ticks, not in one";
}

TEST(ServoThreadTest, APassThatNobodyEndedDoesNotHoldItUpForEver) {
  auto parts = std::make_unique<Parts>();
  ServoThread servo(parts->loop, parts->task, longest_fade(Parts::limits()));
  parts->task.start(parts->pass, 0);
  servo.start();
  parts->run_until(50);
  servo.end();
  EXPECT_FALSE(servo.runs());
}

TEST(ServoThreadTest, ALibraryThatHangsIsASentence) {
  auto parts = std::make_unique<Parts>();
  parts->device.on_read = [&hang = parts->hang](std::size_t tick, device::DeviceReading&) {
    while (tick == 50) {
      hang = true;
      std::this_thread::sleep_for(std::chrono::hours(1));
    }
    return true;
  };
  auto servo = std::make_unique<ServoThread>(parts->loop, parts->task, 0.1);
  servo->start();
  parts->run_until(50);
  StallWatch watch(parts->loop);
  test::wait_until([&] { return watch.stalled(); });
  EXPECT_TRUE(parts->hang);
  EXPECT_THAT(test::message_of<DeviceHangs>([&] { servo->end(); }),
              testing::HasSubstr("does not come back"));
  EXPECT_TRUE(servo->hangs());
  static_cast<void>(servo.release());  // the thread may come back to both
  static_cast<void>(parts.release());
}

TEST(StallWatchTest, ALoopThatTicksOrHasNotBegunIsNoStall) {
  auto parts = std::make_unique<Parts>();
  StallWatch watch(parts->loop);
  for (int i = 0; i < 30; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_FALSE(watch.stalled()) << "not begun";
  }
  ServoThread servo(parts->loop, parts->task, 0.1);
  servo.start();
  for (int i = 0; i < 30; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_FALSE(watch.stalled()) << i;
  }
  servo.end();
}

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
