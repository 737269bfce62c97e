// A virtual surgeon's reactions to hints, by hand.

#include "core/subject/drilling/hint_heeding.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::subject {
namespace {

constexpr double kTick = 1e-3;
constexpr double kReaction = 0.5;
constexpr std::uint8_t kForce = hint::bit(hint::HintKind::kForce);
constexpr std::uint8_t kSpeed = hint::bit(hint::HintKind::kSpeed);
constexpr std::uint8_t kHidden = hint::bit(hint::HintKind::kHidden);

/// @returns how often what is done had to end
int show(HintHeeding& heeding, std::uint8_t hints, double seconds) {
  int ends = 0;
  for (int i = 0; i < static_cast<int>(seconds / kTick); ++i) {
    ends += heeding.notice(hints, kTick) ? 1 : 0;
  }
  return ends;
}

TEST(HintHeedingTest, AHintActsOnceAfterTheReactionTime) {
  HintHeeding heeding(1.0, kReaction, RandomStream(1, "hints"));
  EXPECT_EQ(show(heeding, kForce, 0.49), 0);
  EXPECT_EQ(heeding.lightness(), 1.0);
  EXPECT_EQ(show(heeding, kForce, 0.1), 0) << "it drills on, more lightly";
  EXPECT_NEAR(heeding.lightness(), 0.6, 0.002);
  show(heeding, kForce, 1.0);
  EXPECT_LT(heeding.lightness(), 0.63) << "once for each hint";
  EXPECT_GT(heeding.lightness(), 0.60);
  show(heeding, 0, 0.1);
  for (int again = 0; again < 6; ++again) {
    show(heeding, kForce, 0.6);
    show(heeding, 0, 0.1);
  }
  EXPECT_GE(heeding.lightness(), 0.3);
  EXPECT_LT(heeding.lightness(), 0.32);
  const double before = 1.0 - heeding.lightness();
  show(heeding, 0, 30.0);
  EXPECT_NEAR((1.0 - heeding.lightness()) / before, std::exp(-1.0), 1e-3);
}

TEST(HintHeedingTest, SpeedAndWhatIsHiddenEndTheBout) {
  HintHeeding heeding(1.0, kReaction, RandomStream(1, "hints"));
  EXPECT_EQ(show(heeding, kSpeed, 0.8), 1);
  EXPECT_NEAR(heeding.pace(), 0.7, 0.01);
  EXPECT_EQ(heeding.lightness(), 1.0);
  EXPECT_FALSE(heeding.looks());
  show(heeding, 0, 0.1);
  EXPECT_EQ(show(heeding, kHidden, 0.8), 1);
  EXPECT_TRUE(heeding.looks());
  show(heeding, 0, 16.0);
  EXPECT_FALSE(heeding.looks());
}

TEST(HintHeedingTest, ItHeedsItsShareOfHints) {
  HintHeeding never(0.0, kReaction, RandomStream(1, "hints"));
  EXPECT_EQ(show(never, kSpeed | kHidden, 5.0), 0);
  EXPECT_EQ(never.pace(), 1.0);
  HintHeeding some(0.3, kReaction, RandomStream(2, "hints"));
  int heeded = 0;
  constexpr int kHints = 2000;
  for (int i = 0; i < kHints; ++i) {
    heeded += show(some, kHidden, 0.6);
    show(some, 0, 0.01);
  }
  EXPECT_NEAR(heeded, 0.3 * kHints, 4.0 * std::sqrt(0.21 * kHints));
}

TEST(HintHeedingTest, AShortHintIsNotNoticed) {
  HintHeeding heeding(1.0, kReaction, RandomStream(1, "hints"));
  EXPECT_EQ(show(heeding, kSpeed, 0.4), 0);
  EXPECT_EQ(show(heeding, 0, 5.0), 0);
  EXPECT_EQ(heeding.pace(), 1.0);
}

}  // namespace
}  // namespace haptrial::subject
