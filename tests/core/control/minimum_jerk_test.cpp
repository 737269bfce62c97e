#include "core/control/minimum_jerk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::control {
namespace {

using Eigen::Vector3d;

const Vector3d kFrom{0.01, -0.02, 0.03};
const Vector3d kTo{-0.05, 0.02, 0.01};

TEST(MinimumJerkMoveTest, StartsAndEndsAtRestWithoutAcceleration) {
  const MinimumJerkMove move(kFrom, kTo, 0.1);
  const double end = move.duration();
  const double h = 1e-4 * end;
  for (const double t : {0.0, end}) {
    const Vector3d there = t == 0.0 ? kFrom : kTo;
    EXPECT_LT((move.at(t).position - there).norm(), 1e-15);
    EXPECT_LT(move.at(t).velocity.norm(), 1e-15);
    // Inside by h: displacement of order h^3, speed of order h^2, acceleration of order h.
    const double inside = t == 0.0 ? h : end - h;
    const double further = t == 0.0 ? 2 * h : end - 2 * h;
    const double way = (kTo - kFrom).norm();
    EXPECT_LT((move.at(inside).position - there).norm(), 11.0 * way * 1e-12);
    EXPECT_LT(move.at(inside).velocity.norm(), 31.0 * way / end * 1e-8);
    const Vector3d acceleration = (move.at(further).velocity - move.at(inside).velocity) / h;
    EXPECT_LT(acceleration.norm(), 100.0 * way / end / end * 1e-4);
  }
}

TEST(MinimumJerkMoveTest, StaysAtItsEnds) {
  const MinimumJerkMove move(kFrom, kTo, 0.1);
  EXPECT_EQ(move.at(-1.0).position, kFrom);
  EXPECT_EQ(move.at(move.duration() + 1.0).position, kTo);
  EXPECT_TRUE(move.at(-1.0).velocity.isZero());
  EXPECT_TRUE(move.at(move.duration() + 1.0).velocity.isZero());
}

TEST(MinimumJerkMoveTest, PeakSpeedIsTheOneAskedForHalfWay) {
  for (const double peak : {0.01, 0.1, 0.7}) {
    const MinimumJerkMove move(kFrom, kTo, peak);
    double fastest = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      fastest = std::max(fastest, move.at(move.duration() * i / 1000.0).velocity.norm());
    }
    EXPECT_NEAR(fastest, peak, peak * 1e-12);
    EXPECT_NEAR(move.at(0.5 * move.duration()).velocity.norm(), peak, peak * 1e-12);
    EXPECT_LT((move.at(0.5 * move.duration()).position - 0.5 * (kFrom + kTo)).norm(), 1e-15);
  }
}

TEST(MinimumJerkMoveTest, GoesStraightAndNeverBack) {
  const MinimumJerkMove move(kFrom, kTo, 0.1);
  const Vector3d way = kTo - kFrom;
  double before = -1.0;
  for (int i = 0; i <= 1000; ++i) {
    const Vector3d gone = move.at(move.duration() * i / 1000.0).position - kFrom;
    const double share = gone.dot(way) / way.squaredNorm();
    EXPECT_GE(share, before);
    EXPECT_LT((gone - share * way).norm(), 1e-15);
    before = share;
  }
  EXPECT_DOUBLE_EQ(before, 1.0);
}

TEST(MinimumJerkMoveTest, VelocityIsTheSlopeOfPosition) {
  const MinimumJerkMove move(kFrom, kTo, 0.1);
  const double h = 1e-5;
  for (double t = 0.01; t < move.duration() - 0.01; t += 0.013) {
    const Vector3d slope = (move.at(t + h).position - move.at(t - h).position) / (2.0 * h);
    EXPECT_LT((move.at(t).velocity - slope).norm(), 1e-9) << t;
  }
}

TEST(MinimumJerkMoveTest, NoNeighbourHasLessJerk) {
  // The squared jerk of p + e w, with w zero at the ends up to the second derivative, is least at
  // e = 0: sampled by third differences, with w = u^3 (1 - u)^3 c(u).
  const MinimumJerkMove move({0, 0, 0}, {1, 0, 0}, 1.875);  // lasts 1 s
  const auto cost = [&](double e, double wave) {
    constexpr int kSteps = 400;
    const double h = 1.0 / kSteps;
    const auto p = [&](int i) {
      const double u = i * h;
      return move.at(u).position.x() + e * std::pow(u * (1.0 - u), 3) * std::cos(wave * u);
    };
    double sum = 0.0;
    for (int i = 0; i + 3 <= kSteps; ++i) {
      // Differences stand for their middle; the outermost also for the strip beside the end.
      const double width = i == 0 || i + 3 == kSteps ? 2.0 * h : h;
      const double jerk = (p(i + 3) - 3 * p(i + 2) + 3 * p(i + 1) - p(i)) / (h * h * h);
      sum += jerk * jerk * width;
    }
    return sum;
  };
  EXPECT_NEAR(cost(0.0, 0.0), 720.0, 720.0 * 2e-3) << "the least possible, 720 D^2 / T^5";
  for (const double wave : {0.0, 2.0, 7.0}) {
    for (const double e : {-2.0, 2.0}) {
      EXPECT_GT(cost(e, wave), cost(0.0, 0.0)) << wave << " " << e;
    }
  }
}

TEST(MinimumJerkMoveTest, AMoveOfNoLengthIsOverAtOnce) {
  const MinimumJerkMove move(kFrom, kFrom, 0.1);
  EXPECT_EQ(move.duration(), 0.0);
  EXPECT_EQ(move.at(0.0).position, kFrom);
  EXPECT_TRUE(move.at(0.0).velocity.isZero());
  EXPECT_TRUE(MinimumJerkMove().at(0.0).position.isZero());
}

TEST(MinimumJerkMoveTest, AskingDoesNotAllocate) {
  const test::AllocationGuard guard;
  const MinimumJerkMove move(kFrom, kTo, 0.1);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) {
    sum += move.at(1e-3 * i).position;
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(sum.allFinite());
}

}  // namespace
}  // namespace haptrial::control
