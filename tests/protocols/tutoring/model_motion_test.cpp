#include "protocols/tutoring/model_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
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

/// At x = t² along a line, with a force of t.
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
    const control::Partner now = playback.now();
    ASSERT_NEAR(now.tool.position.x(), time * time, 2.6e-5) << "a chord of the parabola";
    ASSERT_NEAR(now.tool.velocity.x(), 0.5 * 2.0 * time, 1e-12);
    ASSERT_NEAR(now.force.y(), time, 1e-12);
    playback.step(1e-3);
    time += 0.5e-3;
  }
  EXPECT_NEAR(time, 1.0, 1e-3);
  EXPECT_TRUE(playback.now().force.isZero(0.0));
  EXPECT_TRUE(playback.now().tool.velocity.isZero(0.0));
  EXPECT_EQ(playback.now().tool.position.x(), 1.0);
}

}  // namespace
}  // namespace haptrial::protocols
