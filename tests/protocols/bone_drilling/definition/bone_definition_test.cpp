// Definition of a drilling, and the sentences about its mistakes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/bone/record/recorded_bone.h"
#include "core/sound/spectrum_table.h"
#include "experiments/studies/experiment.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/load_bones.h"
#include "protocols/definition/button_uses.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const std::vector<std::pair<std::string, std::string>>& lines) {
  try {
    protocols::parse_bone_definition(test::drilling_with(lines), "study.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(BoneDefinitionTest, TheShippedOneIsValid) {
  EXPECT_EQ(refusal({}), "");
  const protocols::BoneDefinition d =
      protocols::parse_bone_definition(test::drilling_with({}), "bone_drilling.toml");
  EXPECT_EQ(d.name, "bone_drilling");
  EXPECT_EQ(d.simulator.tools.size(), 3u);
  EXPECT_EQ(std::get<bone::BurrTool>(d.simulator.tools[0].kind).burr.diameter, 0.006);
  EXPECT_NE(d.simulator.tools[2].as<bone::SuctionTool>(), nullptr);
  EXPECT_EQ(d.drilling.controls.buttons[static_cast<std::size_t>(bone::Function::kNextTool)], 2u);
  EXPECT_EQ(d.drilling.controls.keys[static_cast<std::size_t>(bone::Function::kPower)],
            (std::vector<int>{' '}));
  // x into the head goes down, y to the back comes to the participant: z, up, goes to the left.
  EXPECT_LT((d.placement.turn.col(2) + Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(d.placement.turn.determinant(), 1.0, 1e-12);
}

TEST(BoneDefinitionTest, EachMistakeGetsASentence) {
  EXPECT_THAT(refusal({{"time_limit", "time_limit = -1.0"}}),
              AllOf(HasSubstr("drilling.time_limit is -1"), HasSubstr("[s]")));
  EXPECT_THAT(refusal({{"in_hand", "in_hand = [\"cutting\", \"saw\"]"}}), HasSubstr("tools.saw"));
  EXPECT_THAT(refusal({{"in_hand", "in_hand = []"}}), HasSubstr("tools.in_hand is an empty array"));
  EXPECT_THAT(refusal({{"type", "type = \"spoon\""}}), HasSubstr("tools.cutting.type"));
  EXPECT_THAT(refusal({{"y_to", "y_to = [0.0, 1.0, 0.0]"}}), HasSubstr("square to x_to"));
  EXPECT_THAT(refusal({{"x_to", "x_to = [0.0, 0.0]"}}), HasSubstr("three numbers"));
  EXPECT_THAT(refusal({{"handle", "handle = [0.0, 0.0, 0.0]"}}), HasSubstr("along the handle"));
  EXPECT_THAT(refusal({{"force_limit", "force_limit = 9.5"}}),
              HasSubstr("at most envelope.max_force, 9"));
  EXPECT_THAT(refusal({{"next_tool", "next_tool = [1.5]"}}), HasSubstr("those of buttons"));
  EXPECT_THAT(refusal({{"carry", "carry = [\"pedal\"]"}}), HasSubstr("space, enter, A to Z"));
  EXPECT_THAT(refusal({{"carry", "juggle = [\"J\"]"}}), HasSubstr("keys.juggle"));
  EXPECT_THAT(refusal({{"up", "up = [0.0, 0.17, 0.084]"}}), HasSubstr("across the view"));
  EXPECT_THAT(refusal({{"procedures", "procedures = 0"}}), HasSubstr("design.procedures"));
  EXPECT_THAT(refusal({{"start", "start = [0.0, 0.08, 0.0]"}}),
              HasSubstr("within envelope.workspace_radius"));
  EXPECT_THAT(refusal({{"protocol", "protocol = \"bone_drilling\"\nspeed = 1.0"}}),
              HasSubstr("experiment.speed"));
}

TEST(BoneDefinitionTest, ABoneThatIsNotThereIsNamed) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml",
                   test::drilling_with({{"bones", "bones = [\"nowhere.nrrd\"]"}}));
  try {
    load_experiment(folder / "study.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere.nrrd"));
  }
}

/// A sound in full scale would be a vibration of as many newtons.
TEST(BoneDefinitionTest, SpectraOfTheOtherUnitAreRefused) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "newtons.toml", sound::to_toml(sound::default_vibration()));
  test::write_text(folder / "full.toml", sound::to_toml(sound::default_sound()));
  const auto problem = [&](const std::string& keys) -> std::string {
    std::string text = test::drilling_with({});
    const std::string table = "[sound]\n";
    const std::size_t at = text.find(table);
    at == std::string::npos ? text += "\n" + table + keys : text.insert(at + table.size(), keys);
    test::write_text(folder / "study.toml", text);
    try {
      protocols::load_bone_definition(folder / "study.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem("spectra = \"full.toml\"\nvibration = \"newtons.toml\"\n"), "");
  EXPECT_THAT(problem("vibration = \"full.toml\"\n"),
              HasSubstr("sound.vibration is full.toml, which has the unit full scale; allowed: "
                        "spectra of the unit N"));
  EXPECT_THAT(problem("spectra = \"newtons.toml\"\n"), HasSubstr("which has the unit N; allowed"));
}

TEST(BoneDefinitionTest, TheProtocolIsFoundByItsName) {
  const Experiment bone = parse_experiment(test::drilling_with({}), "a.toml");
  EXPECT_EQ(bone.definition->protocol, "bone_drilling");
  EXPECT_EQ(bone.study->protocol().name(), "bone_drilling");
  const Experiment force = load_experiment(test::shipped_definition());
  EXPECT_EQ(force.definition->protocol, "force_training");
  EXPECT_EQ(force.study->protocol().name(), "force_training") << "which it leaves out";
}

TEST(BoneDefinitionTest, ABoneComesBackFromItsRecord) {
  bone::BoneModel model = test::two_slabs();
  model.density.assign(model.labels.size(), 0.0F);
  for (std::size_t i = 0; i < model.labels.size(); ++i) {
    model.density[i] = model.labels[i] == 0 ? 0.0F : i % 3 == 0 ? 0.5F : 1.0F;
  }
  const bone::BoneModel back = bone::model_of(bone::record_of(model, 0));
  EXPECT_EQ(back.name, model.name);
  EXPECT_EQ(back.labels, model.labels);
  EXPECT_EQ(back.density, model.density);
  EXPECT_EQ(back.grid.size, model.grid.size);
  EXPECT_EQ(back.grid.spacing, model.grid.spacing);
  ASSERT_EQ(back.structures.size(), 3u);
  EXPECT_EQ(back.structures[2].name, "facial nerve");
  EXPECT_EQ(back.structures[2].hardness, 0.5);
  EXPECT_TRUE(back.structures[2].vital);
  record::BoneRecord damaged = bone::record_of(model, 0);
  damaged.runs.back().count = 1 << 30;
  EXPECT_THROW(bone::model_of(damaged), InputError);
  damaged = bone::record_of(model, 0);
  damaged.structures.pop_back();
  EXPECT_THROW(bone::model_of(damaged), InputError);
}

// Buttons that two keys of a drilling use: validate and run say so.

using testing::ElementsAre;
using testing::IsEmpty;
using Lines = std::vector<std::pair<std::string, std::string>>;

std::vector<std::string> warnings(const Lines& lines,
                                  const std::vector<std::string>& devices = {}) {
  return protocols::button_warnings(
      protocols::parse_bone_definition(test::drilling_with(lines), "study.toml"), devices);
}

TEST(DrillingButtonsTest, TwoFunctionsOfOneButtonAreNamed) {
  EXPECT_THAT(warnings({}), IsEmpty());
  EXPECT_THAT(warnings({{"previous_tool", "previous_tool = [2, 1]"}}),
              ElementsAre("buttons.next_tool and buttons.previous_tool both take button 1, so that "
                          "one press does both; give one of them another button"));
}

TEST(DrillingButtonsTest, AStopButtonThatTakesAToolIsNamed) {
  EXPECT_THAT(warnings({}, {"haply"}),
              ElementsAre("haply.stop_button is 2 by default, and buttons.previous_tool "
                          "takes button 2, too, so that who presses it stops the session; give one "
                          "of them another button"));
  EXPECT_THAT(warnings({}, {"force-dimension"}), IsEmpty());  // -1
  EXPECT_THAT(
      warnings({{"stop_button", "stop_button = 2"}}),
      ElementsAre(HasSubstr("force_dimension.stop_button is 2, and buttons.previous_tool")));
}

TEST(DrillingButtonsTest, ValidateAndRunSayIt) {
  const test::TemporaryFolder folder;
  const auto study =
      test::write_small_drilling(folder.path(), 5.0, {{"stop_button", "stop_button = 2"}});
  const std::string sentence =
      "warning: force_dimension.stop_button is 2, and buttons.previous_tool takes button 2, too";
  const auto validated =
      test::run_command(fmt::format("haptrial validate '{}/study.toml'", folder.path().string()));
  EXPECT_EQ(validated.status, 0) << validated.errors;
  EXPECT_THAT(validated.output, HasSubstr(sentence));
  const auto run = test::run_command(
      fmt::format("haptrial run '{0}/study.toml' --subject P01 --device haply --out '{0}/out'",
                  folder.path().string()));
  EXPECT_NE(run.status, 0);  // there is no such device here
  EXPECT_THAT(run.output, HasSubstr("warning: haply.stop_button is 2 by default, and "
                                    "buttons.previous_tool takes button 2, too"));
}

}  // namespace
}  // namespace haptrial::experiments
