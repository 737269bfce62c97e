// Nobody is hurt: a pass with every hand from the bare handle to 2 kg, on every loop, and a handle
// that is let go in the middle of it.

#include <gtest/gtest.h>

#include <vector>

#include "protocols/force_training/passes/recall.h"
#include "protocols/force_training/passes/training_pass.h"
#include "tests/support/pass_run.h"

namespace haptrial::protocols {
namespace {

using test::Loop;
using test::PassRun;
using test::published;

std::vector<Loop> loops() {
  return {{1000.0, 1}, {1000.0, 2}, {1000.0, 3}, {2000.0, 1},
          {2000.0, 3}, {4000.0, 1}, {4000.0, 3}};
}

constexpr double kBurst = 0.030;  // [s]

TEST(EveryHandTest, APassIsQuietWithEveryHandOnEveryLoop) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const Loop& loop : loops()) {
    for (const double mass : {0.001, 0.1, 0.3, 0.5, 0.8, 2.0}) {
      SCOPED_TRACE(testing::Message() << mass << " kg, " << loop.rate << " Hz, " << loop.delay);
      RecallTest pass(stimulus, published(loop), 1);
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
        const auto pass = make_training_pass(condition, stimulus, published(loop), 1);
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

/// The damping of the source, whatever the hand: what the loop did before it was governed.
TEST(EveryHandTest, WhatOscillatesAllTheSameIsEndedWithin100Milliseconds) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const double mass : {0.0, 0.1, 0.3}) {
    const Loop loop{1000.0, 1};
    GuidanceParameters ungoverned = published(loop);
    ungoverned.loop.handle_mass = 1000.0;  // a handle so heavy that it carries everything
    RecallTest pass(stimulus, ungoverned, 1);
    PassRun run(pass, loop, 1.0);
    run.advance_to(record::Stage::kRun);
    run.hand().press = 2.0;
    run.advance(1.0);
    ASSERT_FALSE(run.idle());
    run.hand().hold(mass);
    run.hand().press = 0.0;
    const double at_limit = run.advance(3.0);
    EXPECT_TRUE(run.idle()) << mass;
    EXPECT_EQ(run.fault(), device::Fault::kOscillation) << device::describe(run.fault());
    EXPECT_TRUE(run.force.isZero(0.0));
    EXPECT_LE(at_limit, 0.100) << mass;
  }
}

}  // namespace
}  // namespace haptrial::protocols
