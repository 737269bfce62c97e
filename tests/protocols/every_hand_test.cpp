// Nobody is hurt: a pass with every hand from the bare handle to 2 kg, on every loop, and a handle
// that is let go in the middle of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "protocols/force_training/training_pass.h"
#include "protocols/force_training/trajectory_pass.h"
#include "tests/support/pass_run.h"

namespace haptrial::protocols {
namespace {

using test::Loop;
using test::PassRun;

std::vector<Loop> loops() {
  return {{1000.0, 1}, {1000.0, 2}, {1000.0, 3}, {2000.0, 1},
          {2000.0, 3}, {4000.0, 1}, {4000.0, 3}};
}

constexpr double kBurst = 0.045;  // [s]

TEST(EveryHandTest, APassIsQuietWithEveryHandOnEveryLoop) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const Loop& loop : loops()) {
    for (const double mass : {0.001, 0.1, 0.3, 0.5, 0.8, 2.0}) {
      SCOPED_TRACE(testing::Message() << mass << " kg, " << loop.rate << " Hz, " << loop.delay);
      TrajectoryPass pass(kRecallTest, stimulus, GuidanceParameters{}, 1);
      PassRun run(pass, loop, mass);
      double at_limit = run.advance_to(record::Stage::kRun);
      ASSERT_EQ(run.stage, record::Stage::kRun) << device::describe(run.fault());
      run.hand().press = 4.0;
      at_limit += run.advance(4.0);
      EXPECT_LE(at_limit, kBurst);
      EXPECT_FALSE(run.idle()) << device::describe(run.fault());
    }
  }
}

TEST(EveryHandTest, AHandleThatIsLetGoInMidPassIsQuiet) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const Loop& loop : loops()) {
    for (const char* condition : {"visual", "visuohaptic"}) {
      for (const double press : {0.0, 3.0, 8.0}) {
        SCOPED_TRACE(testing::Message() << condition << " pressed with " << press << " N, "
                                        << loop.rate << " Hz, " << loop.delay);
        const auto pass = make_training_pass(condition, stimulus, GuidanceParameters{}, 1);
        PassRun run(*pass, loop, 1.0);
        run.advance_to(record::Stage::kRun);
        run.hand().press = press;
        run.advance(2.0);
        run.hand().hold(0.0);
        run.hand().press = 0.0;
        EXPECT_LE(run.advance(0.3), kBurst);
        EXPECT_EQ(run.advance(3.0), 0.0);
      }
    }
  }
}

/// The guard's damper included, which comes for a light hand that the plane makes swing.
TEST(EveryHandTest, NoForceIsBeyondTheLimitOfGuidance) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  GuidanceParameters guidance;
  guidance.force_limit = 2.0;
  for (const double mass : {0.001, 0.05}) {
    TrajectoryPass pass(kRecallTest, stimulus, guidance, 1);
    PassRun run(pass, {1000.0, 3}, mass);
    double most = 0.0;
    for (int i = 0; i < 8000 && !run.idle(); ++i) {
      run.hand().press = i > 4000 ? 1.0 : 0.0;
      run.advance(1e-3);
      most = std::max(most, run.force.norm());
    }
    EXPECT_GT(most, 1.5) << mass;
    EXPECT_LE(most, 2.0 + 1e-9) << mass;
  }
}

/// The plane of the source far below the envelope's limit, by a protocol that does not give way.
class StubbornPass final : public Pass {
 public:
  PassOutput tick(const Readings& readings, double) noexcept override {
    const PointState& tool = readings[0].tool;
    PassOutput out;
    out.force.y() = std::clamp(-2000.0 * tool.position.y() - 300.0 * tool.velocity.y(), -5.0, 5.0);
    out.stage = record::Stage::kRun;
    return out;
  }
  PassState state() const noexcept override { return PassState::kRunning; }
};

TEST(EveryHandTest, WhatOscillatesAllTheSameIsEndedWithinAQuarterOfASecond) {
  for (const double mass : {0.0, 0.1, 0.3}) {
    StubbornPass pass;
    PassRun run(pass, {1000.0, 1}, mass);
    run.hand().press = 2.0;
    for (int i = 0; i < 100 && !run.idle(); ++i) {
      run.advance(0.01);
    }
    EXPECT_TRUE(run.idle()) << mass;
    EXPECT_EQ(run.fault(), device::Fault::kOscillation) << device::describe(run.fault());
    EXPECT_TRUE(run.force.isZero(0.0));
  }
}

}  // namespace
}  // namespace haptrial::protocols
