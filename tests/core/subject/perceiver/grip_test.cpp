#include "core/subject/perceiver/grip.h"

#include <gtest/gtest.h>

#include "core/subject/perceiver/sight.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject {
namespace {

constexpr double kDt = 1e-3;

Grip::Tip tip(double y, double force, double speed = 0.0) {
  Grip::Tip tip;
  tip.state.position.y() = y;
  tip.state.velocity.y() = speed;
  tip.force.y() = force;
  return tip;
}

TEST(GripTest, TheWayIsThatOfTipsThatTouchAndRest) {
  Grip grip{SenseParameters{}};
  for (int i = 0; i < 300; ++i) {  // on the way together: no contact
    grip.feel(tip(0.04, 0.0, -0.1), tip(-0.04, 0.0, 0.1), kDt);
  }
  EXPECT_FALSE(grip.held());
  for (int i = 0; i < 100; ++i) {  // one touches
    grip.feel(tip(0.03, 1.0, -0.1), tip(-0.04, 0.0, 0.1), kDt);
  }
  EXPECT_FALSE(grip.held());
  for (int i = 0; i < 100; ++i) {  // both, still moving
    grip.feel(tip(0.03, 1.0, -0.1), tip(-0.03, 1.0, 0.1), kDt);
  }
  EXPECT_TRUE(grip.held());
  EXPECT_NEAR(grip.met().amount, 0.06, 1e-12) << "better than nothing";
  for (int i = 0; i < 500; ++i) {
    grip.feel(tip(0.025, 1.5), tip(-0.025, 0.5), kDt);
  }
  EXPECT_NEAR(grip.met().amount, 0.05, 1e-12);
  EXPECT_NEAR(grip.met().force, 1.0, 1e-12);
  grip.begin();
  EXPECT_FALSE(grip.held());
}

TEST(GripTest, DoesNotAllocate) {
  Grip grip{SenseParameters{}};
  const haptrial::test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    grip.feel(tip(0.025, 1.0), tip(-0.025, 1.0), kDt);
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(SightTest, SpreadFollowsTheNoiseAndThePerson) {
  const SightParameters known{{0.0, 1.0, 2.0}, {0.002, 0.004, 0.010}, 0.0};
  const Sight sight(known, 1);
  EXPECT_DOUBLE_EQ(sight.spread_at(0.0), 0.002);
  EXPECT_DOUBLE_EQ(sight.spread_at(1.5), 0.007);
  EXPECT_DOUBLE_EQ(sight.spread_at(9.0), 0.010);
  EXPECT_DOUBLE_EQ(sight.see(0.05, 1.0, 2.0).estimate, 0.058);
  SightParameters varied = known;
  varied.spread = 0.3;
  double sum = 0.0, squares = 0.0;
  constexpr int kPeople = 4000;
  for (std::uint64_t seed = 1; seed <= kPeople; ++seed) {
    const double log = std::log(Sight(varied, seed).spread_at(0.0) / 0.002);
    sum += log;
    squares += log * log;
  }
  EXPECT_NEAR(sum / kPeople, 0.0, 4.0 * 0.3 / std::sqrt(kPeople));
  EXPECT_NEAR(std::sqrt(squares / kPeople), 0.3, 4.0 * 0.3 / std::sqrt(2.0 * kPeople));
}

TEST(SightTest, RefusesWhatIsNoFunctionOfNoise) {
  EXPECT_THROW(check(SightParameters{{}, {}, 0.0}), std::invalid_argument);
  EXPECT_THROW(check(SightParameters{{0.0, 0.0}, {1.0, 1.0}, 0.0}), std::invalid_argument);
  EXPECT_THROW(check(SightParameters{{0.0, 1.0}, {1.0}, 0.0}), std::invalid_argument);
  EXPECT_THROW(check(SightParameters{{0.0}, {0.0}, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::subject
