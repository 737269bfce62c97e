#include "core/control/curve_constraint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/free_mass.h"

namespace haptrial::control {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// A loop in space with radii of curvature from some millimetres on.
Points loop(std::size_t count = 20001) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back({0.04 * std::cos(a), 0.01 * std::sin(3.0 * a), 0.04 * std::sin(2.0 * a)});
  }
  return points;
}

Points line(double length = 0.2) { return {{0, 0, 0}, {0.5 * length, 0, 0}, {length, 0, 0}}; }

TEST(CurveConstraintTest, PullsAcrossTheCurveAndDampsOnlyThere) {
  const SampledCurve curve(line());
  CurveConstraint constraint(curve, {900.0, 100.0});
  constraint.start({0.05, 0.0, 0.0});
  const Vector3d force = constraint.force({{0.05, 0.002, -0.001}, {0.3, 0.02, 0.01}});
  EXPECT_NEAR(force.x(), 0.0, 1e-12) << "free along the curve, however fast";
  EXPECT_NEAR(force.y(), -900.0 * 0.002 - 100.0 * 0.02, 1e-9);
  EXPECT_NEAR(force.z(), 900.0 * 0.001 - 100.0 * 0.01, 1e-9);
}

TEST(CurveConstraintTest, TheForceIsPerpendicularToTheCurve) {
  RandomStream random(1, "perpendicular");
  const SampledCurve curve(loop());
  CurveConstraint constraint(curve, {900.0, 100.0});
  for (int i = 0; i < 3000; ++i) {
    const double arc = curve.length() * random.uniform(0.05, 0.95);
    constraint.start_at(arc);
    const Vector3d aside(random.normal(), random.normal(), random.normal());
    const Vector3d velocity(random.normal(), random.normal(), random.normal());
    const Vector3d force =
        constraint.force({curve.at(arc).position + 1e-4 * aside, 0.1 * velocity});
    ASSERT_NEAR(constraint.direction().norm(), 1.0, 1e-9);
    ASSERT_LT(std::abs(force.dot(constraint.direction())), 1e-9 * (1.0 + force.norm())) << i;
  }
}

TEST(CurveConstraintTest, AClosedSlowWayCostsWhatTheDamperTakes) {
  // Around the loop and back to its start, on a way that winds about the curve at a distance.
  const SampledCurve curve(loop());
  for (const double damping : {0.0, 20.0}) {
    CurveConstraint constraint(curve, {900.0, damping});
    double work = 0.0;
    double taken = 0.0;
    const auto tool_at = [&](double u) {
      const double arc = curve.length() * (0.5 - 0.45 * std::cos(2.0 * M_PI * u));
      const double a = 40.0 * M_PI * u;
      return Vector3d(curve.at(arc).position +
                      1e-3 * Vector3d(std::cos(a), std::sin(2.0 * a), std::sin(a)));
    };
    constexpr int kSteps = 200000;
    constexpr double kDuration = 20.0;
    constraint.start_at(curve.length() * 0.05);
    Vector3d before = tool_at(0.0);
    for (int i = 1; i <= kSteps; ++i) {
      const Vector3d after = tool_at(static_cast<double>(i) / kSteps);
      const Vector3d velocity = (after - before) * (kSteps / kDuration);
      const Vector3d force = constraint.force({0.5 * (before + after), velocity});
      work += force.dot(after - before);
      const Vector3d u = constraint.direction();
      const Vector3d across = velocity - u.dot(velocity) * u;
      taken += damping * across.squaredNorm() * kDuration / kSteps;
      before = after;
    }
    const double stored = 0.5 * 900.0 * 2e-6;  // by the spring at its longest [J]
    EXPECT_NEAR(work, -taken, 1e-3 * stored) << damping;
    EXPECT_EQ(taken > 0.0, damping > 0.0);
  }
}

TEST(CurveConstraintTest, ABeadOnALineKeepsItsSpeed) {
  const SampledCurve curve(line(10.0));
  CurveConstraint constraint(curve, {2000.0, 50.0});
  test::FreeMass bead(0.2, {{0.01, 0.003, -0.002}, {0.7, 0.0, 0.1}},
                      test::FreeMass::Rule::kSymplectic);
  constraint.start(bead.state().position);
  for (int i = 0; i < 10000; ++i) {
    bead.step(constraint.force(bead.state()), 1e-3);
    ASSERT_NEAR(bead.state().velocity.x(), 0.7, 1e-9);
  }
  EXPECT_LT(bead.state().position.tail<2>().norm(), 1e-9) << "it has come to rest on the line";
}

TEST(CurveConstraintTest, ABeadOnALoopNeverGainsEnergy) {
  const SampledCurve curve(loop());
  CurveConstraint constraint(curve, {900.0, 10.0});
  const Vector3d along = (curve.at(0.011).position - curve.at(0.01).position).normalized();
  test::FreeMass bead(0.2, {curve.at(0.01).position + Vector3d(0.0, 1e-3, 0.0), 0.1 * along},
                      test::FreeMass::Rule::kSymplectic);
  constraint.start_at(0.01);
  const auto energy = [&] {
    const double d = constraint.place().distance;
    return 0.5 * 900.0 * d * d + 0.5 * 0.2 * bead.state().velocity.squaredNorm();
  };
  constraint.follow(bead.state());
  const double start = energy();
  double lowest = start;
  double furthest = 0.0;
  for (int i = 0; i < 200000; ++i) {
    bead.step(constraint.force(bead.state()), 2e-5);
    furthest = std::max(furthest, constraint.place().arc);
    ASSERT_LT(energy(), lowest + 2e-3 * start) << i;  // the ripple of the step
    lowest = std::min(lowest, energy());
  }
  EXPECT_GT(furthest, 0.2) << "it went round";
}

TEST(CurveConstraintTest, BeyondAnEndItHoldsToThePoint) {
  const SampledCurve curve(line());
  CurveConstraint constraint(curve, {900.0, 100.0});
  constraint.start_at(0.2);
  const Vector3d beyond = constraint.force({{0.202, 0.001, 0.0}, {0.05, 0.0, 0.0}});
  EXPECT_NEAR(beyond.x(), -900.0 * 0.002 - 100.0 * 0.05, 1e-9);
  EXPECT_NEAR(beyond.y(), -0.9, 1e-9);
  constraint.start_at(0.0);
  const Vector3d before = constraint.force({{-0.002, 0.0, 0.0}, {0.05, 0.0, 0.0}});
  EXPECT_NEAR(before.x(), 900.0 * 0.002 - 100.0 * 0.05, 1e-9);
  EXPECT_NEAR(constraint.force({{0.0005, 0.0, 0.0}, {0.05, 0.0, 0.0}}).x(), 0.0, 1e-12);
}

/// A hand that passes an end at 0.12 m/s, there and back: 1 mm takes it 8 ms.
TEST(CurveConstraintTest, TheDamperAlongTheCurveGrowsBeyondAnEnd) {
  const SampledCurve curve(line(0.016));
  CurveConstraint constraint(curve, {900.0, 80.0});
  constraint.start_at(0.015);
  const auto along = [&](double beyond, double speed) {
    return constraint.force({{0.016 + beyond, 0.0, 0.0}, {speed, 0.0, 0.0}}).x();
  };
  EXPECT_NEAR(along(0.0005, 0.12), -900.0 * 0.0005 - 0.5 * 80.0 * 0.12, 1e-9);
  for (const double speed : {0.12, -0.12}) {
    double before = along(-0.12e-3 * 10, speed);
    for (int i = -9; i <= 20; ++i) {
      const double force = along(0.12e-3 * i, speed);
      ASSERT_LT(std::abs(force - before), 0.12 * (80.0 * 0.12 + 1.0)) << i;
      before = force;
    }
  }
}

TEST(CurveConstraintTest, AToolThatIsNowhereFeelsNothing) {
  const SampledCurve curve(line());
  CurveConstraint constraint(curve, {900.0, 100.0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(constraint.force({{nan, 0.0, 0.0}, Vector3d::Zero()}).isZero());
  EXPECT_TRUE(constraint.force({{0.01, 0.0, 0.0}, {0.0, nan, 0.0}}).isZero());
}

TEST(CurveConstraintTest, ForceDoesNotAllocate) {
  const SampledCurve curve(loop());
  CurveConstraint constraint(curve, {900.0, 100.0});
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    constraint.force({curve.at(1e-5 * i).position, Vector3d::Ones()});
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::control
