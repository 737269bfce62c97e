// Stills that a participant can call up: they change the picture and nothing else.

#include "protocols/bone_drilling/display/stage_stills.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/render/bone/bone_stills.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/bone_pictures.h"
#include "protocols/bone_drilling/drilling_pass.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

/// The cavity of a small bone: a cone into the upper slab, beside the nerve in the lower one.
std::string with_stills(const std::string& stills, bool cavity = true) {
  return test::drilling_with({{"x_to", "x_to = [1.0, 0.0, 0.0]"},
                              {"y_to", "y_to = [0.0, 1.0, 0.0]"},
                              {"centre", "centre = [0.0, 0.0, 0.0]"},
                              {"stereo", "stereo = false\n" + stills},
                              {"zoom_in", "zoom_in = [\"I\"]\nstill = [\"B\"]"}}) +
         (cavity ? "\n[cavity]\nbeside = \"facial nerve\"\noffset = [0.0, 0.0025, 0.0]\n"
                   "radius = 0.003\nmargin = 0.0005\n"
                 : "");
}

std::shared_ptr<protocols::BoneStage> stage_of(const protocols::BoneDefinition& d) {
  auto stage = std::make_shared<protocols::BoneStage>();
  stage->model = std::make_shared<const bone::BoneModel>(test::two_slabs());
  stage->start_view = d.simulator.camera.start;
  stage->simulator = std::make_unique<bone::Simulator>(
      *stage->model, protocols::simulator_for(d, stage->model->grid));
  stage->companions = std::make_unique<bone::SteppedCompanions>(
      *stage->simulator, protocols::companions_for(d, stage->model->grid), d.rate);
  return stage;
}

TEST(ScreenStillsTest, EachPressBringsTheNextAndAfterTheLastNone) {
  protocols::BoneDefinition d =
      protocols::parse_bone_definition(with_stills("stills = 2"), "study.toml");
  d.display.width = 320;
  d.display.height = 200;
  const auto stage = stage_of(d);
  const auto stills = protocols::screen_stills(d, *stage->model);
  ASSERT_EQ(stills->size(), 2u);
  EXPECT_EQ((*stills)[0].width, 160);
  EXPECT_NE((*stills)[0].rgb, (*stills)[1].rgb);
  protocols::BoneRenderer renderer(d, stage);
  bone::DrillingView seen = protocols::view_of(*stage->simulator, {});
  const auto drawn = [&](int asked) {
    seen.stills_asked = asked;
    return renderer.draw(seen);
  };
  drawn(0);  // from the second on, a view at rest draws what is visible alone
  drawn(0);
  const render::Image none = drawn(0);
  const render::Image first = drawn(1);
  const render::Image second = drawn(2);
  EXPECT_EQ(drawn(3).rgb, none.rgb);
  EXPECT_EQ(drawn(4).rgb, first.rgb);
  EXPECT_NE(first.rgb, second.rgb);
  const Eigen::Vector4d place = render::BoneStills::place_of((*stills)[0], 320, 200);
  for (const render::Image* image : {&first, &second}) {
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 320; ++x) {
        const bool corner = x >= place[0] - 2 && y <= place[1] + place[3] + 2;
        const auto at = static_cast<std::size_t>(3 * (320 * y + x));
        ASSERT_TRUE(corner || image->rgb[at] == none.rgb[at]) << x << ", " << y;
      }
    }
  }
}

TEST(ScreenStillsTest, TheBoneIsTheSameWhetherTheyAreAskedForOrNot) {
  const protocols::BoneDefinition d =
      protocols::parse_bone_definition(with_stills("stills = 2"), "study.toml");
  const auto drilled = [&](bool asks) {
    const auto stage = stage_of(d);
    bone::SimulatorInput input;
    input.tool.tip.position = {0.0, 0.020, 0.0};
    stage->simulator->begin(0);
    for (int tick = 0; tick < 800; ++tick) {
      input.tool.tip.position.y() -= 2e-5;
      input.functions = bone::bit(bone::Function::kPower);
      input.functions |= asks && tick % 100 < 50 ? bone::bit(bone::Function::kStill) : 0;
      input.power = 1.0;
      stage->simulator->tick(input);
    }
    EXPECT_EQ(stage->simulator->stills_asked(), asks ? 8 : 0);
    EXPECT_GT(stage->simulator->emptied_so_far(), 20u);
    return stage->simulator->checksum();
  };
  EXPECT_EQ(drilled(true), drilled(false));
}

TEST(ScreenStillsTest, WithoutACavityTheyAreRefusedAndWithoutTheKeyThereAreNone) {
  try {
    protocols::parse_bone_definition(with_stills("stills = 2", false), "study.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr(
            "display.stills needs a cavity, whose stages the stills show; add a table [cavity]"));
  }
  const protocols::BoneDefinition d =
      protocols::parse_bone_definition(with_stills("", true), "study.toml");
  EXPECT_EQ(protocols::screen_stills(d, test::two_slabs()), nullptr);
}

}  // namespace
}  // namespace haptrial::experiments
