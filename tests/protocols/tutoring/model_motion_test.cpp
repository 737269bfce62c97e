#include "protocols/tutoring/model_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "core/base/error.h"
#include "protocols/tutoring/tutored_trials.h"
#include "tests/support/message_of.h"

namespace haptrial::protocols {
namespace {

TEST(TutorChoiceTest, FileTrialAndMark) {
  EXPECT_EQ(read_tutor_choice("a/S01.h5").file, "a/S01.h5");
  EXPECT_FALSE(read_tutor_choice("S01.h5").trial);
  EXPECT_EQ(read_tutor_choice("S01.h5:3").trial, 3);
  const TutorChoice marked = read_tutor_choice("S01.h5:3@2.5");
  EXPECT_EQ(marked.trial, 3);
  EXPECT_EQ(marked.from, 2.5);
  for (const char* text : {"", ":1", "S01.h5:", "S01.h5:0", "S01.h5:x", "S01.h5:1@", "S01.h5:1@-1",
                           "S01.h5:1@nan", "S01.h5:1@2s"}) {
    EXPECT_THROW(read_tutor_choice(text), InputError) << text;
  }
}

/// A motion at x = t² along a line, with a force of t.
ModelMotion accelerating() {
  ModelMotion m;
  m.rate = 100.0;
  for (int i = 0; i <= 100; ++i) {
    const double t = i / m.rate;
    m.ticks.push_back({{{t * t, 0.0, 0.0}, {2.0 * t, 0.0, 0.0}}, {0.0, t, 0.0}});
  }
  return m;
}

TEST(PlaybackTest, AtHalfTheSpeedPlacesAndForcesAreTheSameAndVelocitiesHalf) {
  const ModelMotion motion = accelerating();
  Playback playback(motion, 0.5, 0.2);
  double time = 0.2;
  while (!playback.over()) {
    const tutoring::Partner now = playback.now();
    ASSERT_NEAR(now.tool.position.x(), time * time, 2.6e-5) << "a chord of the parabola";
    ASSERT_NEAR(now.tool.velocity.x(), 0.5 * 2.0 * time, 1e-12);
    ASSERT_NEAR(now.force.y(), time, 1e-12);
    playback.step(1e-3);
    time += 0.5e-3;
  }
  EXPECT_NEAR(time, 1.0, 1e-3);
  double velocity = playback.now().tool.velocity.x();
  EXPECT_NEAR(velocity, 1.0, 0.02);
  for (int i = 0; i < 80; ++i) {
    playback.step(1e-3);
    EXPECT_EQ(playback.now().force.y(), 1.0);
    EXPECT_EQ(playback.now().tool.position.x(), 1.0);
    EXPECT_NEAR(playback.now().tool.velocity.x(), velocity, 1.0 / 79.0) << "without a step";
    velocity = playback.now().tool.velocity.x();
  }
  EXPECT_NEAR(velocity, 0.0, 1e-12);
}

TEST(PlaybackTest, ItComesToRestWithoutAStepAndWhileItWaitsItsForceStays) {
  const ModelMotion motion = accelerating();
  Playback playback(motion, 1.0, 0.5);
  playback.wait(true);
  double velocity = playback.now().tool.velocity.x();
  for (int i = 0; i < 100; ++i) {
    playback.step(1e-3);
    ASSERT_LE(playback.now().tool.velocity.x(), velocity + 2e-3);
    ASSERT_GE(playback.now().tool.velocity.x(), velocity - 0.015);
    velocity = playback.now().tool.velocity.x();
  }
  EXPECT_EQ(velocity, 0.0);
  EXPECT_NEAR(playback.time(), 0.5 + 0.5 * 0.081, 1e-9);
  EXPECT_NEAR(playback.now().force.y(), playback.time(), 1e-9);
  playback.wait(false);
  for (int i = 0; i < 100; ++i) {
    playback.step(1e-3);
  }
  EXPECT_NEAR(playback.now().tool.velocity.x(), 2.0 * playback.time(), 1e-9);
}

/// A pass that runs for a second.
class PlainPass final : public Pass {
 public:
  void begin(std::uint64_t) noexcept override {}
  PassOutput tick(const Readings&, double) noexcept override {
    PassOutput out;
    out.stage = record::Stage::kRun;
    ++ticks_;
    return out;
  }
  PassState state() const noexcept override {
    return ticks_ < 1000 ? PassState::kRunning : PassState::kCompleted;
  }

 private:
  int ticks_{0};
};

TEST(TutoredPassTest, ARecordedRunWaitsWhileThePauseIsAskedForInAnyProtocol) {
  const ModelMotion motion = accelerating();
  TutoringOptions options;
  options.pause_buttons = 2;
  TutoringLog log(4096, 4);
  PlainPass inner;
  TutoredPass pass(inner, options, motion, 0.0, log);
  pass.begin(0);
  for (int i = 0; pass.state() == PassState::kRunning; ++i) {
    device::DeviceReading reading;
    reading.buttons = i >= 200 && i < 350 ? 2 : 1;
    reading.keys = i >= 450 && i < 500 ? kPauseBit : 0;
    pass.tick(reading, 1e-3);
  }
  std::vector<record::TutoringRow> rows;
  log.flush([&rows](std::span<const record::TutoringRow> some) {
    rows.insert(rows.end(), some.begin(), some.end());
  });
  ASSERT_EQ(rows.size(), 1000u);
  double before = 1e-3;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double step = rows[i].time - rows[i - 1].time;
    const bool waits = (i > 201 && i <= 351) || (i > 451 && i <= 501);
    ASSERT_NEAR(step - before, 0.0, 1e-3 / 80.0 + 1e-9) << i;
    ASSERT_FALSE(waits ? step > before + 1e-12 : step < before - 1e-12) << i;
    before = step;
    if (i > 282 && i <= 351) {
      ASSERT_NEAR(step, 0.0, 1e-12) << i;
    }
  }
}

/// A tutor presses with 6 N to the end of the recording, and moves; who is led holds still.
TEST(TutoredPassTest, AtTheEndOfTheRecordingAndOfTheRunTheForceIsGivenBackWithoutAStep) {
  ModelMotion motion;
  motion.rate = 1000.0;
  for (int i = 0; i <= 400; ++i) {
    motion.ticks.push_back({{{1e-4 * i, 0.0, 0.0}, {0.1, 0.0, 0.0}}, {0.0, 6.0, 0.0}});
  }
  TutoringOptions options;
  options.ramp = 0.2;
  options.gains = {0.0, 100.0, 1.0};
  TutoringLog log(4096, 4);
  PlainPass inner;
  TutoredPass pass(inner, options, motion, 0.0, log);
  pass.begin(0);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  double largest = 0.0;
  while (pass.state() == PassState::kRunning) {
    const Eigen::Vector3d force = pass.tick(Readings{device::DeviceReading{}}, 1e-3).force;
    ASSERT_LT((force - before).norm(), 0.25);
    largest = std::max(largest, force.y());
    before = force;
  }
  EXPECT_NEAR(largest, 6.0, 1e-9);
  EXPECT_TRUE(before.isZero(1e-12)) << "the lead has been given back";
}

}  // namespace
}  // namespace haptrial::protocols
