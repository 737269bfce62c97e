#include "protocols/psychophysics/presentation/cursor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/allocation_guard.h"

namespace haptrial::protocols {
namespace {

constexpr double kRate = 1000.0;
constexpr ScreenPlane kAbove{true}, kFront{false};

TEST(CursorTest, WithoutKeysItIsTheTool) {
  Cursor cursor(CursorParameters{}, kAbove, kRate, 1);
  EXPECT_TRUE(cursor.follow({0.01, 0.02, -0.03}).isApprox(Eigen::Vector3d(0.01, 0.02, -0.03)));
}

TEST(CursorTest, ItsWayIsTurnedAsTheParticipantSeesItAndScaled) {
  CursorParameters p;
  p.about = {0.01, 0.0, 0.0};
  p.rotation = M_PI / 2.0;
  p.gain = 2.0;
  // From above up on the screen is -z; a way to the right becomes one up.
  EXPECT_TRUE(Cursor(p, kAbove, kRate, 1)
                  .follow({0.03, 0.005, 0.0})
                  .isApprox(Eigen::Vector3d(0.01, 0.005, -0.04)));
  EXPECT_TRUE(Cursor(p, kFront, kRate, 1)
                  .follow({0.03, 0.0, 0.005})
                  .isApprox(Eigen::Vector3d(0.01, 0.04, 0.005)));
}

TEST(CursorTest, AClampedCursorKeepsTheLengthOfTheWayAlone) {
  CursorParameters p;
  p.clamped = 1.0;
  p.direction = M_PI;
  Cursor cursor(p, kFront, kRate, 1);
  EXPECT_TRUE(cursor.follow({0.03, 0.04, 0.0}).isApprox(Eigen::Vector3d(-0.05, 0.0, 0.0)));
}

TEST(CursorTest, ADelayedCursorIsWhereTheToolWas) {
  CursorParameters p;
  p.delay = 0.1;
  Cursor cursor(p, kAbove, kRate, 1);
  for (int tick = 0; tick < 500; ++tick) {
    const double expected = 1e-4 * std::max(0, tick - 100);
    EXPECT_DOUBLE_EQ(cursor.follow({1e-4 * tick, 0.0, 0.0}).x(), expected) << tick;
  }
}

TEST(CursorTest, NoiseHasItsSpreadInBothDirectionsOfTheScreenAndNoneAcross) {
  CursorParameters p;
  p.noise = 0.002;
  p.noise_time = 0.01;
  Cursor cursor(p, kAbove, kRate, 3);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  constexpr int kTicks = 400'000;
  for (int tick = 0; tick < kTicks; ++tick) {
    squares += cursor.follow(Eigen::Vector3d::Zero()).cwiseAbs2() / kTicks;
  }
  // Some 10,000 independent values.
  EXPECT_NEAR(std::sqrt(squares.x()), 0.002, 0.0001);
  EXPECT_NEAR(std::sqrt(squares.z()), 0.002, 0.0001);
  EXPECT_EQ(squares.y(), 0.0);
}

TEST(CursorTest, ATickDoesNotAllocate) {
  CursorParameters p;
  p.delay = 0.05;
  p.noise = 0.001;
  p.rotation = 0.5;
  Cursor cursor(p, kAbove, kRate, 3);
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 100; ++tick) {
    cursor.follow({1e-4 * tick, 0.0, 0.0});
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols
