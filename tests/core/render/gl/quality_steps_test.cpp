#include "core/render/gl/quality_steps.h"

#include <gtest/gtest.h>

namespace haptrial::render {
namespace {

/// Frames until it is less or more than it was; -1: not within `most`.
int frames_until(QualitySteps& steps, Quality wanted, double interval, int most = 100000) {
  for (int frame = 1; frame <= most; ++frame) {
    if (steps.next(interval) == wanted) {
      return frame;
    }
  }
  return -1;
}

TEST(QualityStepsTest, AFastScreenIsDrawnInFullForEver) {
  QualitySteps steps;
  EXPECT_EQ(frames_until(steps, Quality::kShaded, 1.0 / 60.0), -1);
  EXPECT_EQ(frames_until(steps, Quality::kShaded, 1.0 / 30.0), -1) << "fast enough";
}

TEST(QualityStepsTest, ASlowOneGivesUpAStepASecond) {
  QualitySteps steps;
  EXPECT_EQ(frames_until(steps, Quality::kShaded, 0.05), 30);
  EXPECT_EQ(frames_until(steps, Quality::kPlain, 0.05), 30);
  EXPECT_EQ(frames_until(steps, Quality::kFull, 0.05), -1);
  QualitySteps other;
  EXPECT_EQ(frames_until(other, Quality::kShaded, 1.0 / 29.0), 30) << "less than 30 a second";
}

TEST(QualityStepsTest, WhatIsTooMuchIsTriedEverMoreRarely) {
  QualitySteps steps;
  const auto interval = [&] { return steps.now() == Quality::kFull ? 0.045 : 0.016; };
  int full = 0;
  constexpr int kFrames = 200000;
  for (int frame = 0; frame < kFrames; ++frame) {
    full += steps.next(interval()) == Quality::kFull ? 1 : 0;
  }
  EXPECT_LT(full, kFrames / 50);
  EXPECT_GT(full, 30) << "it is tried again, since a machine may become free";
}

TEST(QualityStepsTest, APauseSaysNothing) {
  QualitySteps steps;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(steps.next(30.0), Quality::kFull);
    EXPECT_EQ(steps.next(0.0), Quality::kFull);
  }
}

}  // namespace
}  // namespace haptrial::render
