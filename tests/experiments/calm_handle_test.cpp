// Whole sessions of trials and of force training, with hands from a finger to a heavy one: the
// handle never buzzes, and no force steps that nobody asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/control/loop_margin.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/definition/definition.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/swings.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::calm_handle_test {
namespace {

struct Outcome {
  double train{0.0};  // seconds in the longest
  double step{0.0};   // of the force from one tick to the next, but for the cut of a fault [N]
  int passes{0};
  int aborted{0};
};

void give_hand(protocols::Definition& definition, double mass) {
  definition.hand.hand_mass = mass;
  definition.hand.damping = 15.0 * mass / 0.8;
  definition.hand.stiffness = 250.0 * mass / 0.8;
}

Outcome outcome_of(const record::SessionReader& reader, double rate) {
  Outcome outcome;
  const std::vector<record::Sample> samples = reader.samples(0, reader.sample_count());
  std::array<std::vector<double>, 3> forces;
  std::set<std::uint64_t> cuts;  // ticks on which a fault took the force
  for (const record::PassRow& pass : reader.passes()) {
    ++outcome.passes;
    if (pass.status == record::PassStatus::kAborted) {
      ++outcome.aborted;
      cuts.insert(pass.last_sample);
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d& force = samples[i].force;
    for (int axis = 0; axis < 3; ++axis) {
      forces[static_cast<std::size_t>(axis)].push_back(force[axis]);
    }
    if (i > 0 && !cuts.contains(samples[i].sequence)) {
      outcome.step = std::max(outcome.step, (force - samples[i - 1].force).norm());
    }
  }
  for (const std::vector<double>& each : forces) {
    outcome.train = std::max(outcome.train, test::longest_train(each, rate));
  }
  return outcome;
}

Outcome session_of(const protocols::Protocol& protocol, const protocols::Definition& definition,
                   int trials) {
  const test::TemporaryFolder folder;
  SessionRequest request = test::session_request(protocol, definition, folder / "S01.h5", 1);
  request.max_trials = trials;
  run_session(request);
  return outcome_of(record::SessionReader(request.file), definition.rate);
}

/// @param felt  tables of [fields], and what the stage "feel" has beside them
Outcome trials_with(const std::string& felt, const std::string& stage, const std::string& action,
                    double mass, const std::string& more = "") {
  const std::string text = fmt::format(R"(
[experiment]
protocol = "trials"
name = "calm"
[design]
participants = 2
{}
[[stages]]
name = "feel"
{}
[response]
question = "Did you feel it?"
choices = [{{ value = "yes" }}, {{ value = "no" }}]
[[blocks]]
name = "one"
trials = 3
[observer]
decides = "yes"
criterion = 0.15
[observer.actions]
feel = {}
{}
)",
                                       felt, stage, action, more);
  Table root = Table::parse(text, "calm.toml");
  const auto definition = protocols::trials_protocol().read(root, "calm.toml", nullptr);
  root.finish();
  give_hand(*definition, mass);
  return session_of(protocols::trials_protocol(), *definition, 3);
}

const std::string kFeel = "fields = [\"f\"]\nuntil = { time = 2.0 }";
const std::string kPress = "{ do = \"press\", force = 3.0 }";
const std::string kHold = "{ do = \"hold\" }";
constexpr std::array kHands{0.001, 0.05, 0.15, 0.3, 0.5, 0.8, 2.0};  // [kg]

std::string plane(double limit) {
  return fmt::format(
      "[fields.f]\ntype = \"plane\"\nthrough = [0.0, 0.0, 0.0]\nnormal = [0.0, 1.0, 0.0]\n"
      "stiffness = 2000.0\ndamping = 300.0\nlimit = {}\n",
      limit);
}

TEST(CalmHandleTest, ThePlaneOfTheSourceBuzzesUnderNoHand) {
  for (const double limit : {3.0, 5.0, 6.0, 8.0}) {
    for (const double mass : kHands) {
      const Outcome outcome = trials_with(plane(limit), kFeel, kPress, mass);
      EXPECT_LE(outcome.train, 0.2) << limit << " N, " << mass << " kg";
      EXPECT_TRUE(outcome.aborted == 0 || mass < 0.1) << limit << " N, " << mass << " kg";
    }
  }
}

TEST(CalmHandleTest, AVirtualMassBuzzesUnderNoHand) {
  const std::string mass_field =
      "[fields.f]\ntype = \"inertia\"\nmass = 2.0\nacceleration_filter = 30.0\nlimit = 5.0\n";
  for (const double mass : kHands) {
    const Outcome outcome = trials_with(mass_field, kFeel, kPress, mass);
    EXPECT_LE(outcome.train, 0.2) << mass << " kg";
  }
}

TEST(CalmHandleTest, AWallThatNoHandCarriesGivesWay) {
  for (const double stiffness : {5000.0, 50'000.0}) {
    const std::string wall = fmt::format(
        "[fields.f]\ntype = \"wall\"\npoint = [0.0, -0.005, 0.0]\nnormal = [0.0, 1.0, 0.0]\n"
        "stiffness = {}\ndamping = 0.0\nlimit = 5.0\n",
        stiffness);
    for (const double mass : kHands) {
      const Outcome outcome = trials_with(wall, kFeel, kPress, mass);
      EXPECT_LE(outcome.train, 0.25) << stiffness << " N/m, " << mass << " kg";
    }
  }
}

TEST(CalmHandleTest, TheForceFadesWhereATrialEnds) {
  const std::string push =
      "[fields.f]\ntype = \"constant\"\nforce = [0.0, -3.0, 0.0]\nfade_out = {}\n";
  for (const double fade : {0.0, 0.05, 1.0}) {
    const Outcome outcome = trials_with(fmt::format(fmt::runtime(push), fade), kFeel, kHold, 0.8);
    EXPECT_LE(outcome.step, 0.5) << fade << " s";
  }
}

TEST(CalmHandleTest, WhatBeginsAroundTheHandPushesByDegrees) {
  const std::string far_spring =
      "[fields.f]\ntype = \"spring\"\nto = [0.0, 0.05, 0.0]\nstiffness = 2000.0\ndamping = 5.0\n"
      "limit = 8.0\nfade_in = 0.0\n";
  const std::string sphere =
      "[fields.f]\ntype = \"sphere\"\ncentre = [0.0, 0.004, 0.0]\nradius = 0.02\n"
      "stiffness = 5000.0\ndamping = 5.0\nlimit = 8.0\nfade_in = 0.0\n";
  for (const std::string& field : {far_spring, sphere}) {
    for (const double mass : {0.3, 0.8, 2.0}) {
      const Outcome outcome = trials_with(field, kFeel, kHold, mass);
      EXPECT_LE(outcome.step, 1.5) << mass << " kg; the sphere gives 5 N a millimetre\n" << field;
      EXPECT_LE(outcome.train, 0.2) << mass << " kg\n" << field;
    }
  }
}

TEST(CalmHandleTest, StagesThatAlternateDoNotShakeTheHand) {
  std::string fields =
      "[fields.up]\ntype = \"constant\"\nforce = [0.0, 5.5, 0.0]\nfade_in = 0.0\nfade_out = 0.0\n"
      "[fields.down]\ntype = \"constant\"\nforce = [0.0, -5.5, 0.0]\nfade_in = 0.0\n"
      "fade_out = 0.0\n";
  for (int i = 0; i < 20; ++i) {
    fields +=
        fmt::format("[[stages]]\nname = \"s{}\"\nfields = [\"{}\"]\nuntil = {{ time = 0.02 }}\n", i,
                    i % 2 == 0 ? "up" : "down");
  }
  const Outcome outcome = trials_with(fields, "until = { time = 0.02 }", kHold, 0.8);
  EXPECT_LE(outcome.step, 0.5);
  EXPECT_LE(outcome.train, 0.2);
}

/// A wall that fades in around a hand that pushes as hard as it grows.
TEST(CalmHandleTest, AHandThatTensesAgainstAWallIsNotTakenForAFrozenReading) {
  const std::string wall =
      "[fields.f]\ntype = \"wall\"\npoint = [0.0, 0.00265, 0.0]\nnormal = [0.0, 1.0, 0.0]\n"
      "stiffness = 360.0\ndamping = 2.0\nfade_in = 0.1\n";
  const std::string friction =
      "[fields.f]\ntype = \"friction\"\nstatic = 5.0\ndynamic = 5.0\n"
      "stiffness = 20000.0\n";
  for (const std::string& field : {wall, friction}) {
    for (const double force : {0.8, 3.0, 4.5}) {
      for (const double mass : {0.3, 0.8}) {
        const Outcome outcome =
            trials_with(field, kFeel, fmt::format("{{ do = \"press\", force = {} }}", force), mass);
        EXPECT_EQ(outcome.aborted, 0) << force << " N, " << mass << " kg\n" << field;
      }
    }
  }
}

protocols::ForceDefinition force_study(double rate, int delay, double mass) {
  protocols::ForceDefinition d = protocols::load_force_definition(test::shipped_definition());
  d.rate = rate;
  d.device.force_delay = delay;
  give_hand(d, mass);
  return d;
}

TEST(CalmHandleTest, TheForceStudyBuzzesUnderNoHand) {
  for (const double mass : {0.001, 0.05, 0.15, 0.3}) {
    for (const int delay : {1, 3}) {
      const Outcome outcome =
          session_of(protocols::force_training(), force_study(1000.0, delay, mass), 3);
      EXPECT_LE(outcome.train, 0.2) << mass << " kg, " << delay << " ticks";
    }
  }
}

TEST(CalmHandleTest, NothingStepsWhereALedRunEnds) {
  protocols::ForceDefinition d = protocols::load_force_definition(
      test::shipped_definition().parent_path() / "tutoring_study.toml");
  for (const double mass : {0.8, 2.0}) {
    give_hand(d, mass);
    const Outcome outcome = session_of(protocols::force_training(), d, 4);
    EXPECT_LE(outcome.step, 0.8) << mass << " kg; an encoder's step makes 0.5 N";
    EXPECT_EQ(outcome.aborted, 0);
  }
}

/// The time over which velocity is estimated does not follow the rate: an encoder's step is no
/// force of 1.5 N.
TEST(CalmHandleTest, At4000HertzThePlaneDoesNotChatter) {
  const Outcome outcome = session_of(protocols::force_training(), force_study(4000.0, 1, 0.8), 2);
  EXPECT_EQ(outcome.train, 0.0);
  EXPECT_EQ(outcome.aborted, 0);
}

}  // namespace

// Whole sessions with hands that do not carry the damping that the definition asks for.

namespace {

struct LightHandOutcome {
  double at_limit{0.0};  // [s]
  int completed{0};
  int reduced{0};  // passes whose damping was reduced
};

LightHandOutcome session_with(double hand_mass, int trials) {
  const test::TemporaryFolder folder;
  protocols::ForceDefinition definition =
      protocols::load_force_definition(test::shipped_definition());
  const double share = hand_mass / definition.hand.hand_mass;
  definition.hand.hand_mass = hand_mass;
  definition.hand.damping *= share;
  definition.hand.stiffness *= share;
  SessionRequest request =
      test::session_request(protocols::force_training(), definition, folder / "S01.h5", 1);
  request.max_trials = trials;
  run_session(request);
  const record::SessionReader reader(request.file);
  LightHandOutcome outcome;
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
  const LightHandOutcome light = session_with(0.5, 3);
  EXPECT_LT(light.at_limit, 1.0) << "targets of 12 N leave some";
  EXPECT_EQ(light.completed, 6);
  EXPECT_GT(light.reduced, 0);
}

TEST(LightHandTest, AHandThatCarriesItIsGuidedAsTheDefinitionSays) {
  const LightHandOutcome heavy = session_with(1.5, 3);
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
}  // namespace haptrial::experiments::calm_handle_test
