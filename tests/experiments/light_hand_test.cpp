// Whole sessions with hands that do not carry the damping that the definition asks for.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/control/loop_margin.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/trial_facts_of.h"
#include "experiments/runner/session.h"
#include "protocols/definition/handle_loop.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::light_hand_test {
namespace {

struct Outcome {
  double at_limit{0.0};  // [s]
  int completed{0};
  int reduced{0};  // passes whose damping was reduced
};

Outcome session_with(double hand_mass, int trials) {
  const test::TemporaryFolder folder;
  protocols::ForceDefinition definition =
      protocols::load_force_definition(test::shipped_definition());
  const double share = hand_mass / definition.hand.hand_mass;
  definition.hand.hand_mass = hand_mass;
  definition.hand.damping *= share;
  definition.hand.stiffness *= share;
  SessionRequest request;
  request.protocol = &protocols::force_training();
  request.definition = &definition;
  request.subject = "S01";
  request.seed = 1;
  request.file = folder / "S01.h5";
  request.max_trials = trials;
  run_session(request);
  const record::SessionReader reader(request.file);
  Outcome outcome;
  for (const record::Sample& sample : reader.samples(0, reader.sample_count())) {
    outcome.at_limit += sample.force.norm() >= 0.98 * 12.0 ? 1.0 / definition.rate : 0.0;
  }
  const auto passes = reader.passes();
  outcome.completed = static_cast<int>(std::ranges::count_if(
      passes, [](const auto& pass) { return pass.status == record::PassStatus::kCompleted; }));
  outcome.reduced = static_cast<int>(record::reduced_damping(reader).size());
  return outcome;
}

TEST(LightHandTest, ASessionWithAHandOfHalfAKilogramIsQuietAndItsPassesSayWhatWasReduced) {
  const Outcome light = session_with(0.5, 3);
  EXPECT_LT(light.at_limit, 1.0) << "targets of 12 N leave some";
  EXPECT_EQ(light.completed, 6);
  EXPECT_GT(light.reduced, 0);
}

TEST(LightHandTest, AHandThatCarriesItIsGuidedAsTheDefinitionSays) {
  const Outcome heavy = session_with(1.5, 3);
  EXPECT_EQ(heavy.completed, 6);
  EXPECT_EQ(heavy.reduced, 0);
}

TEST(LightHandTest, TheMarginOfTheShippedStudySaysWhichHandsCarryIt) {
  const protocols::ForceDefinition d = protocols::load_force_definition(test::shipped_definition());
  const control::LoopMargin plane =
      control::loop_margin("plane", d.guidance.plane, protocols::handle_loop(d));
  EXPECT_LT(plane.lightest, d.hand.hand_mass) << "the hand of the study carries its gains";
  EXPECT_GT(plane.lightest, 0.5);
  EXPECT_GT(plane.lightest_late, plane.lightest);
  EXPECT_FALSE(control::is_dangerous(plane));
  EXPECT_NE(describe(plane).find("no less than 15.7 N·s/m for the bare handle"), std::string::npos)
      << describe(plane);
  EXPECT_TRUE(
      control::is_dangerous(control::loop_margin("stiff", {20000.0, 300.0}, handle_loop(d))));
}

}  // namespace
}  // namespace haptrial::experiments::light_hand_test
