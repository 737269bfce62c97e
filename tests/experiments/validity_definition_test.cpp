// The definition of the construct-validity study: groups, cavity, virtual surgeons.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/stage_stills.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/shipped.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

std::filesystem::path shipped() {
  return std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / "construct_validity.toml";
}

std::string refusal(const std::string& text) {
  try {
    protocols::parse_bone_definition(text, "study.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ValidityDefinitionTest, TheShippedStudyIsThatOfTheSource) {
  const protocols::BoneDefinition d = protocols::load_bone_definition(shipped());
  ASSERT_EQ(d.groups.size(), 3U);
  EXPECT_EQ(d.groups[0].name, "surgeons");
  EXPECT_EQ(d.groups[2].name, "novices");
  EXPECT_EQ(d.groups[0].participants, 4);
  EXPECT_EQ(d.groups[1].participants, 4);
  EXPECT_EQ(d.groups[2].participants, 7);
  EXPECT_EQ(d.design.trials, 2);
  EXPECT_DOUBLE_EQ(d.practice, 900.0);
  EXPECT_GT(d.group_skills.at("surgeons"), d.group_skills.at("residents"));
  EXPECT_GT(d.group_skills.at("residents"), d.group_skills.at("novices"));
  EXPECT_EQ(find_group(d.groups, 3), &d.groups[0]);
  EXPECT_EQ(find_group(d.groups, 4), &d.groups[1]);
  EXPECT_EQ(find_group(d.groups, 14), &d.groups[2]);
  EXPECT_EQ(find_group(d.groups, 15), nullptr);
  ASSERT_TRUE(d.surgeon);
  EXPECT_EQ(d.simulator.tools[static_cast<std::size_t>(d.surgeon->fine.tool)].name, "diamond");
}

TEST(ValidityDefinitionTest, TheCavityIsBoneWithItsMarginsAndLeadsInward) {
  const protocols::BoneDefinition d = protocols::load_bone_definition(shipped());
  const bone::BoneModel& model = *d.bones.front();
  const Eigen::Isometry3d pose = pose_of(d.placement, model.grid);
  const subject::DrillingChart& chart = *d.charts.front();
  const std::vector<float> depths =
      subject::cavity_depths(model, pose, chart, subject::cavity_floor(chart));
  std::size_t planned = 0;
  for (std::size_t at = 0; at < depths.size(); ++at) {
    if (depths[at] >= 0.0F) {
      ++planned;
      EXPECT_EQ(model.structures[model.labels[at]].name, "bone");
    }
  }
  const double volume = static_cast<double>(planned) * std::pow(model.grid.spacing, 3);
  EXPECT_GT(volume, 1e-6);  // a cortical mastoidectomy takes a few cubic centimetres
  EXPECT_LT(volume, 10e-6);
  // No planned voxel is next to a structure.
  const auto& g = model.grid;
  for (int k = 1; k + 1 < g.size[2]; ++k) {
    for (int j = 1; j + 1 < g.size[1]; ++j) {
      for (int i = 1; i + 1 < g.size[0]; ++i) {
        if (depths[g.index(i, j, k)] < 0.0F) {
          continue;
        }
        for (const std::size_t beside : {g.index(i + 1, j, k), g.index(i - 1, j, k),
                                         g.index(i, j + 1, k), g.index(i, j - 1, k)}) {
          EXPECT_FALSE(model.structures[model.labels[beside]].vital);
        }
      }
    }
  }
}

TEST(ValidityDefinitionTest, WhatDoesNotFitIsSaid) {
  const std::string text = test::read_text(shipped());
  EXPECT_EQ(refusal(text), "");
  EXPECT_THAT(refusal(test::replaced(text, "novices = 7\n", "novices = 8\n")),
              HasSubstr("make it 15, as in design.participants"));
  EXPECT_THAT(refusal(test::replaced(text, "rough = \"cutting\"", "rough = \"suction\"")),
              HasSubstr("a burr of tools.in_hand"));
  EXPECT_THAT(refusal(test::replaced(text, "novices = 0.15", "novices = 1.5")),
              HasSubstr("skill.novices"));
  EXPECT_THAT(
      refusal(test::replaced(text, "margins = [0.002, 0.002, 0.0015]", "margins = [0.002]")),
      HasSubstr("write one for each of the 3 structures"));
}

TEST(ValidityDefinitionTest, FilesOfThePageThatAreNotThereAreNamedBeforeTheSession) {
  const test::TemporaryFolder folder;
  const std::string coarse =
      test::replaced(test::read_text(shipped()), "seed = 1 ", "spacing = 0.001\nseed = 1 ");
  test::write_text(folder / "study.toml", coarse +
                                              "[feedback]\npage = true\nscore = \"score.json\"\n"
                                              "checklist = \"list.toml\"\n");
  const auto warnings = [&] {
    return protocols::load_bone_definition(folder / "study.toml").warnings();
  };
  test::write_text(folder / "list.toml", "");
  const std::string absent = "feedback.score score.json: no such file or folder";
  EXPECT_THAT(warnings(), testing::Contains(HasSubstr(absent)));
  EXPECT_THAT(warnings(), testing::Not(testing::Contains(HasSubstr("list.toml"))));
  test::write_text(folder / "score.json", "");
  EXPECT_THAT(warnings(), testing::Not(testing::Contains(HasSubstr("feedback"))));
}

TEST(ValidityDefinitionTest, ABoneWithoutTheStructureIsRefused) {
  const test::TemporaryFolder folder;
  test::write_text(
      folder / "study.toml",
      test::replaced(test::read_text(shipped()), "beside = \"incus\"", "beside = \"tooth\""));
  EXPECT_THROW(protocols::load_bone_definition(folder / "study.toml"), InputError);
  test::write_text(folder / "study.toml", test::replaced(test::read_text(shipped()),
                                                         "\"facial nerve\"", "\"facial nerv\""));
  try {
    protocols::load_bone_definition(folder / "study.toml");
    ADD_FAILURE() << "a margin to nothing was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cavity.structures names \"facial nerv\""));
  }
}

TEST(StageStillsTest, BoneDisappearsFromStageToStage) {
  protocols::BoneDefinition d = protocols::load_bone_definition(shipped());
  d.display.width = 320;
  d.display.height = 240;
  const std::vector<protocols::StageStill> stills = protocols::stage_stills(d, 3);
  ASSERT_EQ(stills.size(), 3U);
  EXPECT_EQ(stills[0].image.width, 320);
  const auto differs = [&](std::size_t a, std::size_t b) {
    int count = 0;
    for (std::size_t at = 0; at < stills[a].image.rgb.size(); ++at) {
      count += stills[a].image.rgb[at] != stills[b].image.rgb[at] ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(differs(0, 1), 1000);
  EXPECT_GT(differs(1, 2), 1000) << "and deeper within the same opening";
}

}  // namespace
}  // namespace haptrial::experiments
