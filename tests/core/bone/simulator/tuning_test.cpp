// Constants of a simulator that change while it ticks.

#include "core/bone/simulator/tuning.h"

#include <gtest/gtest.h>

#include "core/bone/simulator/simulator.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::tuning_test {
namespace {

using Eigen::Vector3d;
constexpr double kDt = 1e-3;
constexpr double kRadius = 2e-3;
constexpr int kTransition = 250;  // ticks

SimulatorParameters with_burr(double removal_rate, double falloff, double stiffer = 1.0) {
  BurrTool tool;
  tool.burr = default_burr(BurrKind::kCutting, 2.0 * kRadius);
  tool.burr.removal_rate = removal_rate;
  tool.burr.falloff = falloff;
  tool.feel = default_feel(kRadius);
  tool.feel.first_gain *= stiffer;
  tool.feel.second_gain *= stiffer;
  SimulatorParameters p;
  p.tools = {{"burr", 2.5e-3, 0.1, tool}};
  return p;
}

SimulatorInput at(const Vector3d& tip, double power = 0.0) {
  SimulatorInput input;
  input.tool.tip.position = tip;
  input.power = power;
  input.dt = kDt;
  return input;
}

/// A simulator over flat bone whose burr has been free.
class Bench {
 public:
  explicit Bench(const SimulatorParameters& p) : simulator(test::flat_bone(48, 0.5e-3), p) {
    simulator.begin(0);
    tick({0.0, 0.0, 3.0 * kRadius});
  }
  Vector3d tick(const Vector3d& tip, double power = 0.0) {
    return simulator.tick(at(tip, power)).force;
  }
  Simulator simulator;
};

TEST(TuningTest, AHeldBurrGoesEvenlyFromOneLawToTheOther) {
  const Vector3d tip(0.0, 0.0, kRadius - 0.3e-3);
  Bench soft(with_burr(0.0, 0.0));
  Bench hard(with_burr(0.0, 0.0, 3.0));
  const double before = soft.tick(tip).z();
  const double after = hard.tick(tip).z();
  ASSERT_GT(after, before + 1.0);
  soft.simulator.tune(tuning_of(with_burr(0.0, 0.0, 3.0)));
  for (int n = 1; n <= kTransition; ++n) {
    const double expected = before + (after - before) * n / kTransition;
    ASSERT_NEAR(soft.tick(tip).z(), expected, 1e-9) << n;
  }
  EXPECT_FALSE(soft.simulator.is_in_transition());
  EXPECT_EQ(soft.tick(tip).z(), after);
}

TEST(TuningTest, WithoutATransitionTheSameChangeWouldStepIt) {
  const Vector3d tip(0.0, 0.0, kRadius - 0.3e-3);
  Bench soft(with_burr(0.0, 0.0));
  Bench hard(with_burr(0.0, 0.0, 3.0));
  EXPECT_GT(hard.tick(tip).z() - soft.tick(tip).z(),
            5.0 * (2.0 * default_feel(kRadius).force_limit * kDt / ForceTransition::kTime));
}

TEST(TuningTest, ATunedBurrRemovesWhatOneMadeSoRemoves) {
  Bench tuned(with_burr(5.0, 0.0));
  Bench made(with_burr(40.0, 11.0));
  tuned.simulator.tune(tuning_of(with_burr(40.0, 11.0)));
  for (int tick = 0; tick < 600; ++tick) {
    const Vector3d tip(0.0, 1e-6 * tick, kRadius - 4e-7 * tick);
    tuned.tick(tip, 1.0);
    made.tick(tip, 1.0);
  }
  EXPECT_LT(made.simulator.amount_left(), made.simulator.amount_at_start() - 1.0);
  EXPECT_EQ(tuned.simulator.checksum(), made.simulator.checksum());
}

TEST(TuningTest, ServoThreadDoesNotAllocate) {
  Bench bench(with_burr(5.0, 0.0));
  const Tuning other = tuning_of(with_burr(20.0, 3.0, 2.0));
  const test::AllocationGuard guard;
  bench.simulator.tune(other);
  for (int tick = 0; tick < 10; ++tick) {
    bench.tick({0.0, 0.0, kRadius - 0.3e-3}, 1.0);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace haptrial::bone::tuning_test
