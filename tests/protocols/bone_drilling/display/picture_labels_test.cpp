#include "protocols/bone_drilling/display/picture_labels.h"

#include <gtest/gtest.h>

namespace haptrial::protocols {
namespace {

bone::ToolSpec burr_called(const char* name, const bone::BurrDimensions& dimensions) {
  bone::ToolSpec tool;
  tool.name = name;
  bone::BurrTool burr;
  burr.burr.form = dimensions.form;
  burr.burr.diameter = dimensions.diameter;
  burr.burr.length = dimensions.length;
  tool.kind = burr;
  return tool;
}

TEST(PictureLabelsTest, NamesAToolWithItsSizeAndWhatBecameOfIt) {
  bone::ToolSpec ball = burr_called("cutting", {bone::BurrForm::kBall, 6e-3, 0.0, 0.0});
  bone::ToolSpec fissure = burr_called("fissure", {bone::BurrForm::kCylinder, 1.6e-3, 6e-3, 0.0});
  EXPECT_EQ(words_of(ball), "cutting, 6 mm");
  EXPECT_EQ(words_of(fissure), "fissure, 1.6 × 6 mm");
  bone::DrillingView seen;
  seen.sharpness = 0.824;
  EXPECT_EQ(words_of(ball, seen), "cutting, 6 mm") << "it does not wear";
  std::get<bone::BurrTool>(ball.kind).burr.wear_volume = 1e-7;
  seen.reversed = true;
  EXPECT_EQ(words_of(ball, seen), "cutting, 6 mm, 82 % sharp, reversed");
  bone::ToolSpec plane;
  plane.name = "plane";
  plane.kind = bone::CutPlane{};
  EXPECT_EQ(words_of(plane, seen), "plane");
}

}  // namespace
}  // namespace haptrial::protocols
