#include "core/control/pd_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/free_mass.h"

namespace haptrial::control::pd_controller_test {
namespace {

using Eigen::Vector3d;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Vector3d random_vector(RandomStream& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(PdControllerTest, PullsTowardsTheTargetByBothGains) {
  const PdController pd({900.0, 100.0});
  const PointState target{{0.01, 0.0, -0.02}, {0.0, 0.03, 0.0}};
  const PointState tip{{0.0, 0.01, 0.0}, {0.05, 0.0, 0.0}};
  const Vector3d force = pd.force(target, tip);
  EXPECT_DOUBLE_EQ(force.x(), 900.0 * 0.01 - 100.0 * 0.05);
  EXPECT_DOUBLE_EQ(force.y(), -900.0 * 0.01 + 100.0 * 0.03);
  EXPECT_DOUBLE_EQ(force.z(), -900.0 * 0.02);
  EXPECT_TRUE(pd.force(target, target).isZero());
}

TEST(PdControllerTest, ForceIsLinearAndOdd) {
  const PdController pd({700.0, 40.0});
  RandomStream random(1, "linear");
  for (int i = 0; i < 100; ++i) {
    const PointState a{random_vector(random, 0.1), random_vector(random, 1.0)};
    const PointState b{random_vector(random, 0.1), random_vector(random, 1.0)};
    const PointState far{a.position + 2.0 * (b.position - a.position),
                         a.velocity + 2.0 * (b.velocity - a.velocity)};
    EXPECT_TRUE(pd.force(a, b).isApprox(-pd.force(b, a)));
    EXPECT_TRUE(pd.force(far, a).isApprox(2.0 * pd.force(b, a), 1e-9));
  }
}

TEST(PdControllerTest, AnInputThatIsNotFiniteGivesNoForce) {
  const PdController pd({900.0, 100.0});
  for (const double bad : {kNan, kInf, -kInf}) {
    for (int axis = 0; axis < 3; ++axis) {
      PointState moved{{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}};
      moved.position[axis] = bad;
      EXPECT_TRUE(pd.force(moved, {}).isZero());
      EXPECT_TRUE(pd.force({}, moved).isZero());
      moved.position[axis] = 0.0;
      moved.velocity[axis] = bad;
      EXPECT_TRUE(pd.force(moved, {}).isZero());
      EXPECT_TRUE(pd.force({}, moved).isZero());
    }
  }
}

/// Displacement of m x'' + b x' + k x = 0 from x0 at rest.
double released(double m, double b, double k, double x0, double t) {
  const double alpha = b / (2.0 * m);
  const double square = k / m - alpha * alpha;
  if (square > 0.0) {
    const double omega = std::sqrt(square);
    return x0 * std::exp(-alpha * t) * (std::cos(omega * t) + alpha / omega * std::sin(omega * t));
  }
  const double beta = std::sqrt(-square);
  return x0 * std::exp(-alpha * t) *
         (std::cosh(beta * t) + (beta > 0.0 ? alpha / beta * std::sinh(beta * t) : alpha * t));
}

TEST(PdControllerTest, AMassOnItMovesAsTheSecondOrderLawSays) {
  constexpr double kMass = 0.5;
  constexpr double kStep = 2e-6;
  // Undamped, underdamped, critical and the overdamped gains of the study.
  for (const PdGains gains :
       {PdGains{900.0, 0.0}, PdGains{900.0, 10.0}, PdGains{800.0, 40.0}, PdGains{900.0, 100.0}}) {
    const PdController pd(gains);
    test::FreeMass mass(kMass, {{0.01, 0.0, -0.02}, Vector3d::Zero()});
    for (int i = 1; i <= 250000; ++i) {
      mass.step(pd.force({}, mass.state()), kStep);
      if (i % 10000 == 0) {
        const double x = released(kMass, gains.damping, gains.stiffness, 0.01, i * kStep);
        ASSERT_NEAR(mass.state().position.x(), x, 2e-5) << gains.damping << " " << i * kStep;
        ASSERT_NEAR(mass.state().position.z(), -2.0 * x, 4e-5);
        ASSERT_EQ(mass.state().position.y(), 0.0);
      }
    }
  }
}

TEST(PdControllerTest, SpringGivesBackNoMoreEnergyThanItTook) {
  // Along any closed path of the tip about a resting target, the work of the force is -b |v|^2
  // summed: zero without damping, negative with it.
  for (const double damping : {0.0, 5.0}) {
    const PdController pd({900.0, damping});
    double work = 0.0;
    double lost = 0.0;
    constexpr int kSteps = 200000;
    constexpr double kStep = 1.0 / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double a = 2.0 * M_PI * (i + 0.5) / kSteps;
      const PointState tip{
          {0.02 * std::cos(a), 0.01 * std::sin(2 * a), 0.03 * std::sin(a)},
          2.0 * M_PI * Vector3d(-0.02 * std::sin(a), 0.02 * std::cos(2 * a), 0.03 * std::cos(a))};
      work += pd.force({}, tip).dot(tip.velocity) * kStep;
      lost += damping * tip.velocity.squaredNorm() * kStep;
    }
    EXPECT_NEAR(work, -lost, 1e-9);
  }
}

TEST(PdControllerTest, EnergyOfAMassOnAnUndampedSpringDoesNotGrow) {
  const PdController pd({900.0, 0.0});
  const auto energy = [&](const PointState& s) {
    return 0.5 * 900.0 * s.position.squaredNorm() + 0.5 * 0.5 * s.velocity.squaredNorm();
  };
  // The symplectic step keeps the energy within omega · dt of its start for ever.
  test::FreeMass mass(0.5, {{0.02, 0.01, 0.0}, {0.0, 0.3, 0.1}}, test::FreeMass::Rule::kSymplectic);
  const double start = energy(mass.state());
  for (int i = 0; i < 100000; ++i) {
    mass.step(pd.force({}, mass.state()), 1e-4);
    ASSERT_NEAR(energy(mass.state()) / start, 1.0, std::sqrt(900.0 / 0.5) * 1e-4) << i;
  }
}

TEST(PdControllerTest, GainsOutOfBoundsAreRefusedByName) {
  for (const double bad : {-1.0, kNan, kInf}) {
    try {
      PdController pd({bad, 1.0});
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("stiffness"), std::string::npos);
    }
    try {
      PdController pd({1.0, bad});
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("damping"), std::string::npos);
    }
  }
  EXPECT_NO_THROW(PdController({0.0, 0.0}));
}

TEST(PdControllerTest, GainsAreReadWithTheirBounds) {
  Table good = Table::parse("stiffness = 2000.0\ndamping = 300\n", "f.toml");
  const PdGains gains = pd_gains_schema().read(good);
  EXPECT_NO_THROW(good.finish());
  EXPECT_EQ(gains.stiffness, 2000.0);
  EXPECT_EQ(gains.damping, 300.0);
  Table bad = Table::parse("stiffness = -1\ndamping = \"soft\"\n", "f.toml");
  pd_gains_schema().read(bad);
  EXPECT_THROW(bad.finish(), InputError);
}

TEST(PdControllerTest, ForceDoesNotAllocate) {
  const PdController pd({900.0, 100.0});
  const test::AllocationGuard guard;
  Vector3d sum = Vector3d::Zero();
  PointState target;
  for (int i = 0; i < 1000; ++i) {
    target.position.x() = 1e-3 * i;
    sum += saturate(pd.force(target, {}), 5.0);
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum.x(), 0.0);
}

TEST(SaturateTest, LimitsTheLengthAndKeepsTheDirection) {
  RandomStream random(2, "saturate");
  for (int i = 0; i < 10000; ++i) {
    const Vector3d force = random_vector(random, std::pow(10.0, random.uniform(-3.0, 6.0)));
    const double limit = random.uniform(0.0, 20.0);
    const Vector3d out = saturate(force, limit);
    ASSERT_LE(out.norm(), limit * (1.0 + 1e-15) + 1e-300);
    if (force.norm() <= limit) {
      ASSERT_EQ(out, force) << "nothing within the limit is touched";
    } else {
      ASSERT_NEAR(out.norm(), limit, limit * 1e-14);
      ASSERT_NEAR(out.dot(force), limit * force.norm(), 1e-12 * limit * force.norm());
    }
  }
  EXPECT_TRUE(saturate({1.0, 2.0, 3.0}, 0.0).isZero());
}

}  // namespace
}  // namespace haptrial::control::pd_controller_test
