// The trial of a force training that a preview shows is that of a session: forces to the bit, and
// by the law of the springs.

#include "protocols/force_training/guided_passes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/error.h"
#include "protocols/force_training/recorded_pass.h"

namespace haptrial::protocols::guided_passes_test {
namespace {

using Eigen::Vector3d;
using record::Phase;
using record::Stage;

ForceDefinition shipped(const std::string& name) {
  return load_force_definition(std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / name);
}

SessionPlace first_session() {
  SessionPlace place;
  place.subject = "S01";
  place.seed = 1;
  give_seeds(place);
  return place;
}

class GuidedPassesTest : public testing::TestWithParam<const char*> {};

TEST_P(GuidedPassesTest, ForcesAreThoseOfThePassToTheBit) {
  const ForceDefinition d = shipped(GetParam());
  const GuidedTrial trial = guided_trial(d, first_session(), 1);
  ASSERT_EQ(2u, trial.passes.size());
  for (const GuidedPass& shown : trial.passes) {
    EXPECT_TRUE(shown.completed);
    const auto pass =
        make_pass(trial.plan.condition, shown.phase, trial.stimulus, d.guidance, trial.plan.block);
    pass->begin(0);
    for (const GuidedTick& tick : shown.ticks) {
      device::DeviceReading reading;
      reading.tool = tick.hand;
      const PassOutput out = pass->tick(reading, 1.0 / d.rate);
      ASSERT_EQ(out.force, tick.force);
      ASSERT_EQ(out.stage, tick.stage);
      ASSERT_EQ(out.target_force, tick.target_force);
    }
    EXPECT_EQ(PassState::kCompleted, pass->state());
  }
}

TEST_P(GuidedPassesTest, TheHandIsOnThePathWhileItRuns) {
  const ForceDefinition d = shipped(GetParam());
  const GuidedTrial trial = guided_trial(d, first_session(), 1);
  const GuidedPass& training = trial.passes.front();
  EXPECT_GE(training.lasts(Stage::kWait, d.rate), d.guidance.wait);
  if (trial.plan.condition == "watching") {
    return;  // the hand stays at the start
  }
  const double duration = trial.stimulus.path.duration();
  EXPECT_NEAR(training.lasts(Stage::kRun, d.rate), duration, 0.02 * duration);
  const GuidedTick* middle = training.middle_of(Stage::kRun);
  ASSERT_NE(nullptr, middle);
  double nearest = 1.0;
  for (const Vector3d& point : trial.stimulus.path.points()) {
    nearest = std::min(nearest, (point - middle->hand.position).norm());
  }
  EXPECT_LT(nearest, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Shipped, GuidedPassesTest,
                         testing::Values("force_training.toml", "force_training_curve.toml",
                                         "tutoring_study.toml"));

TEST(GuidedTrialTest, BesideThePathASpringPulls) {
  ForceDefinition d = shipped("force_training.toml");
  const GuidedTrial trial = guided_trial(d, first_session(), 1);
  ASSERT_EQ(3u, trial.aside.size());
  for (const ForceAside& aside : trial.aside) {
    const std::size_t middle = aside.offsets.size() / 2;
    ASSERT_DOUBLE_EQ(0.0, aside.offsets[middle]);
    const bool pushed = aside.axis == 1 && trial.plan.condition == "haptic";
    const double k = pushed            ? 0.0
                     : aside.axis == 1 ? d.guidance.plane.stiffness
                                       : d.guidance.trajectory.stiffness;
    const double change = aside.forces[middle + 1][aside.axis] - aside.forces[middle][aside.axis];
    EXPECT_NEAR(-k * aside.offsets[middle + 1], change, 1e-9) << aside.axis;
    for (const Vector3d& force : aside.forces) {
      EXPECT_LE(force.norm(), d.guidance.force_limit + 1e-12);
    }
  }
}

/// The first session of the study of retention is its pre-test, the second trains.
TEST(GuidedTrialTest, ASessionThatOnlyTestsHasNoTraining) {
  const ForceDefinition d = load_force_definition(std::filesystem::path(HAPTRIAL_SOURCE_DIR) /
                                                  "docs/worked/teaching/force_retention.toml");
  const GuidedTrial tested = guided_trial(d, first_session(), 1);
  ASSERT_EQ(1u, tested.passes.size());
  EXPECT_EQ(Phase::kTest, tested.passes.front().phase);
  EXPECT_TRUE(tested.passes.front().completed);
  SessionPlace second = first_session();
  second.session = 2;
  EXPECT_EQ(2u, guided_trial(d, second, 1).passes.size());
}

TEST(GuidedTrialTest, ATrialBeyondTheSessionGetsASentence) {
  const ForceDefinition d = shipped("force_training.toml");
  for (const int number : {0, 1000}) {
    EXPECT_THROW(guided_trial(d, first_session(), number), InputError) << number;
  }
}

}  // namespace
}  // namespace haptrial::protocols::guided_passes_test
