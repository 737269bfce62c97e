// Values that a definition allows but that spoil its data, and those that no session could do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/base/error.h"
#include "experiments/studies/experiment.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/definition/contact_margin.h"
#include "protocols/force_training/force_definition.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class DefinitionWarningsTest : public testing::Test {
 protected:
  Experiment load(const std::string& text) {
    test::write_text(folder_ / "study.toml", text);
    return load_experiment(folder_ / "study.toml");
  }
  std::vector<std::string> warnings(const std::string& key, const std::string& line) {
    return warnings_of(load(test::shipped_with(key, line)));
  }
  std::string problem(const std::string& key, const std::string& line) {
    try {
      load(test::shipped_with(key, line));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder_;
};

TEST_F(DefinitionWarningsTest, TheShippedDefinitionsHaveNone) {
  const std::filesystem::path folder = test::shipped_definition().parent_path();
  for (const char* name : {"force_training.toml", "force_training_curve.toml", "bone_drilling.toml",
                           "construct_validity.toml"}) {
    EXPECT_THAT(warnings_of(load_experiment(folder / name)), IsEmpty()) << name;
  }
}

TEST_F(DefinitionWarningsTest, ParticipantsThatUnbalanceTheOrderAreSaid) {
  EXPECT_THAT(warnings("participants", "participants = 7"),
              ElementsAre(AllOf(HasSubstr("design.participants is 7"),
                                HasSubstr("multiples of 6 participants"))));
  EXPECT_THAT(warnings("participants", "participants = 18"), IsEmpty());
}

struct Spoilt {
  const char* key;
  const char* line;
  std::vector<const char*> parts;
};

TEST_F(DefinitionWarningsTest, EachGetsOneSentenceWithKeyAndNumbers) {
  const Spoilt cases[] = {
      {"plane",
       "plane = { stiffness = 15000.0, damping = 300.0 }",
       {"guidance.plane.stiffness is 15000 N/m", "oscillates above", "is reduced for it"}},
      {"plane",
       "plane = { stiffness = 2000.0, damping = 600.0 }",
       {"guidance.plane.damping is 600 N·s/m", "hand.hand_mass is 0.8 kg"}},
      {"bump_max",
       "bump_max = 16.0",
       {"guidance.force_limit is 12 N", "reaches 16 N", "guidance takes 0.34 N",
        "will be cut off"}},
      {"force_limit",
       "force_limit = 9.0",
       {"guidance.force_limit is 9 N", "reaches 12 N", "% of the pattern will be cut off"}},
      {"max_frequency",
       "max_frequency = 60.0",
       {"force_pattern.max_frequency is 60 Hz; above 50 Hz", "recording.stimulus_rate is 100 Hz"}},
      {"bump_width_min", "bump_width_min = 0.01", {"bump_width_min is 100 Hz; above 50 Hz"}},
      {"max_spatial_frequency", "max_spatial_frequency = 1000.0", {}},
      {"force_weight", "force_weight = 0.0", {}},
      {"penalty", "penalty = 0.0", {"analysis.penalty is 0; the alignment then stretches time"}},
      {"settle_distance",
       "settle_distance = 5e-6",
       {"guidance.settle_distance is 5e-06 m, less than device.position_quantum, 1e-05 m",
        "guidance.wait_timeout, 10 s"}},
      {"settle_distance",
       "settle_distance = 5e-5",
       {"friction of 0.1 N holds the handle 0.000111 m away against 900 N/m"}},
      {"approach_speed",
       "approach_speed = 0.01",
       {"guidance.approach_speed is 0.01 m/s", "takes 28 s, longer than the shortest run, 6.2 s"}}};
  for (const Spoilt& spoilt : cases) {
    const auto found = warnings(spoilt.key, spoilt.line);
    if (spoilt.parts.empty()) {
      EXPECT_THAT(found, IsEmpty()) << spoilt.line;
    }
    std::string all;
    for (const std::string& warning : found) {
      all += warning + "\n";
    }
    for (const char* part : spoilt.parts) {
      EXPECT_THAT(all, HasSubstr(part)) << spoilt.line;
    }
  }
}

TEST_F(DefinitionWarningsTest, TheShareThatIsCutGrowsWithThePattern) {
  const auto share = [&](const char* line) {
    const auto found = warnings("force_limit", line);
    EXPECT_EQ(found.size(), 1u);
    const auto end = found.at(0).find(" % of the pattern");
    return std::stod(found[0].substr(found[0].rfind(' ', end - 1)));
  };
  const double little = share("force_limit = 11.0");
  const double much = share("force_limit = 6.0");
  EXPECT_GT(little, 0.0);
  EXPECT_LT(little, 5.0);
  EXPECT_GT(much, 20.0);
}

TEST_F(DefinitionWarningsTest, ADeviceThatIsWeakerThanThePatternIsNamed) {
  const auto found = warnings_of(
      load(test::shipped_text() + "\n[open_haptics]\nname = \"Touch\"\nmax_force = 3.3\n"
                                  "workspace_radius = 0.05\npatience = 0.02\nstop_button = 1\n"));
  EXPECT_THAT(found, ElementsAre(HasSubstr("open_haptics.max_force is 3.3 N; the force pattern"),
                                 HasSubstr("open_haptics.workspace_radius is 0.05 m; the path")));
}

TEST_F(DefinitionWarningsTest, WithoutWeightsTheAlignmentSeesNothing) {
  std::string text = test::shipped_with("force_weight", "force_weight = 0.0");
  const std::string slope = "slope_weight = 0.5";
  text.replace(text.find(slope), slope.size(), "slope_weight = 0.0");
  EXPECT_THAT(warnings_of(load(text)), ElementsAre(HasSubstr("without looking at them")));
}

TEST_F(DefinitionWarningsTest, WhatNoSessionCouldDoIsRefused) {
  EXPECT_THAT(problem("approach_speed", "approach_speed = 1.0"), "");
  EXPECT_THAT(
      problem("max_speed", "max_speed = 0.05"),
      HasSubstr("guidance.approach_speed is 0.1; allowed: at most envelope.max_speed, 0.05"));
  EXPECT_THAT(problem("max_jump", "max_jump = 5e-5"),
              HasSubstr("guidance.approach_speed is 0.1, which is 0.0001 m in a tick; allowed: at "
                        "most envelope.max_jump in a tick, 5e-05 [m]"));
  EXPECT_THAT(
      problem("bump_width_min", "bump_width_min = 0.001"),
      HasSubstr("force_pattern.bump_width_min is 0.001; allowed: at least two ticks, 0.002"));
  std::string slow = test::shipped_with("rate", "rate = 150.0");
  const std::string frequency = "max_frequency = 0.2";
  slow.replace(slow.find(frequency), frequency.size(), "max_frequency = 80.0");
  EXPECT_THROW(load(slow), InputError);
}

TEST_F(DefinitionWarningsTest, AScoreThatDependsOnNoForceIsRefused) {
  std::string text = test::shipped_text();
  for (const char* key :
       {"force_weight = 1.0", "slope_weight = 0.5", "force_share = 1.0", "slope_share = 0.5"}) {
    const std::string name = std::string(key).substr(0, std::string(key).find('='));
    text.replace(text.find(key), std::string(key).size(), name + "= 0.0");
  }
  EXPECT_THROW(load(text), InputError);
}

TEST_F(DefinitionWarningsTest, ARecordedDefinitionIsReadWhateverItSays) {
  const std::string text = test::shipped_with("max_speed", "max_speed = 0.05");
  EXPECT_NO_THROW(protocols::parse_force_definition(text, "recorded.toml"));
}

TEST_F(DefinitionWarningsTest, ValidateAndDryRunSayThemAndStillSucceed) {
  test::write_text(folder_ / "study.toml",
                   test::shipped_with("settle_distance", "settle_distance = 5e-5"));
  const std::string file = "'" + (folder_ / "study.toml").string() + "'";
  const auto valid = test::run_command("haptrial validate " + file);
  EXPECT_EQ(valid.status, 0);
  EXPECT_THAT(valid.output, HasSubstr("warning: guidance.settle_distance is 5e-05 m"));
  const auto dry =
      test::run_command("haptrial dry-run " + file + " --subjects 1 --trials 1 --out '" +
                        (folder_ / "out").string() + "'");
  EXPECT_THAT(dry.output, HasSubstr("warning: guidance.settle_distance is 5e-05 m"));
  test::write_text(folder_ / "study.toml", test::shipped_with("max_speed", "max_speed = 0.05"));
  EXPECT_EQ(test::run_command("haptrial validate " + file).status, 2);
}

TEST(ContactMarginTest, BoneIsAsStiffAsItWasMeasuredInTheLoop) {
  // docs/algorithms/bone-feel.md, "Stability", by simulation on voxels of 0.5 mm.
  const double at_1_newton[][2] = {{1e-3, 13.9e3}, {2e-3, 6.9e3}, {4e-3, 7.7e3}, {7e-3, 8.2e3}};
  for (const auto& [diameter, measured] : at_1_newton) {
    bone::BurrTool tool;
    tool.burr.diameter = diameter;
    tool.feel = bone::default_feel(0.5 * diameter);
    EXPECT_NEAR(protocols::flat_bone_stiffness(tool, 1.0), measured, 0.1 * measured) << diameter;
  }
}

TEST(ContactMarginTest, AFissureBurrIsStiffestOnItsSide) {
  constexpr double kRadius = 0.8e-3;
  constexpr double kLength = 6e-3;
  bone::BurrTool tool;
  tool.burr = bone::default_burr(
      bone::BurrKind::kCutting,
      bone::BurrDimensions{bone::BurrForm::kCylinder, 2.0 * kRadius, kLength, 0.0});
  tool.feel = bone::default_feel(bone::BurrShape(tool.burr.dimensions()).ball_radius());
  const auto force = [&](double depth) {  // of the segments below a plane
    const double below = kRadius - depth;
    const double area = kRadius * kRadius * std::acos(below / kRadius) -
                        below * std::sqrt(kRadius * kRadius - below * below);
    return bone::magnitude(kLength * area, tool.feel);
  };
  for (const double depth : {0.1e-3, 0.25e-3, 0.4e-3}) {
    const double slope = (force(depth + 1e-7) - force(depth - 1e-7)) / 2e-7;
    EXPECT_NEAR(protocols::flat_bone_stiffness(tool, force(depth)), slope, 0.01 * slope);
  }
}

TEST(ContactMarginTest, TheLoopCarriesLessTheLaterItsForcesCome) {
  control::HandleLoop loop;
  const control::HeldBy hand{0.8, 15.0, 250.0};
  const double one = protocols::stable_stiffness(loop, hand);
  EXPECT_NEAR(one, 2.0 * 15.0 * loop.rate / 3.0, 0.02 * one) << "2 b / 3 T";
  loop.force_delay = 3;
  EXPECT_LT(protocols::stable_stiffness(loop, hand), 0.5 * one);
}

TEST(BoneWarningsTest, ContactVibrationAndDeviceEachGetASentence) {
  const Experiment shipped =
      load_experiment(test::shipped_definition().parent_path() / "bone_drilling.toml");
  protocols::BoneDefinition d = dynamic_cast<const protocols::BoneDefinition&>(*shipped.definition);
  EXPECT_THAT(d.warnings(), IsEmpty());
  d.hand.coulomb_friction = 0.0;
  EXPECT_THAT(d.warnings(), ElementsAre(AllOf(HasSubstr("hand.coulomb_friction is 0"),
                                              HasSubstr("10.0 N/mm at 1000 Hz"))));
  d.drilling.scale = 3.0;
  EXPECT_THAT(d.warnings(), IsEmpty()) << "bone is a third as stiff to the hand";
  d = dynamic_cast<const protocols::BoneDefinition&>(*shipped.definition);
  d.rate = 500.0;
  EXPECT_THAT(d.warnings(), ElementsAre(HasSubstr("lines of up to 341 Hz; those at 250 Hz")));
  d = dynamic_cast<const protocols::BoneDefinition&>(*shipped.definition);
  d.vendor.force_dimension.max_force = 5.0;
  EXPECT_THAT(d.warnings(), ElementsAre(HasSubstr("forces above 5 N will be cut off")));
}

}  // namespace
}  // namespace haptrial::experiments
