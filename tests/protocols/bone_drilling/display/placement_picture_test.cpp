#include "protocols/bone_drilling/display/placement_picture.h"
#include "protocols/bone_drilling/display/placement_legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "tests/experiments/small_drilling.h"

namespace haptrial::protocols {
namespace {

/// Two slabs with a nerve in the lower one, and a cavity into the upper one if asked for.
BoneDefinition placed_slabs(bool cavity) {
  BoneDefinition d = parse_bone_definition(
      test::drilling_with({{"x_to", "x_to = [1.0, 0.0, 0.0]"},
                           {"y_to", "y_to = [0.0, 1.0, 0.0]"},
                           {"centre", "centre = [0.0, 0.0, 0.0]"}}) +
          (cavity ? "\n[cavity]\nbeside = \"facial nerve\"\noffset = [0.0, 0.005, 0.0]\n"
                    "radius = 0.003\nmargin = 0.0005\n"
                  : ""),
      "study.toml");
  d.display.width = 640;
  d.display.height = 360;
  d.bones.push_back(std::make_shared<const bone::BoneModel>(test::two_slabs()));
  if (cavity) {
    const bone::BoneModel& model = *d.bones.front();
    d.charts.push_back(std::make_shared<const subject::DrillingChart>(
        make_chart(model, pose_of(d.placement, model.grid), *d.cavity)));
  }
  return d;
}

/// Pixels that are much more red than anything else.
int red_pixels(const render::Image& image) {
  int red = 0;
  for (std::size_t at = 0; at < image.rgb.size(); at += 3) {
    red += image.rgb[at] > std::max(image.rgb[at + 1], image.rgb[at + 2]) + 60 ? 1 : 0;
  }
  return red;
}

TEST(PlacementPictureTest, AStructureIsWhereTheCameraHasIt) {
  BoneDefinition d = placed_slabs(false);
  const auto placed = placed_structures(d, *d.bones.front(), 640, 360);
  ASSERT_EQ(placed.size(), 1U);
  EXPECT_EQ(placed[0].name, "facial nerve");
  EXPECT_TRUE(placed[0].in_sight);
  // The nerve's middle voxel from the grid's middle: one of two, to the left or to the right.
  const Camera& camera = d.simulator.camera.start;
  const Eigen::Vector3d forward = (camera.target - camera.eye).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  const double side = placed[0].pixel.x() < 320.0 ? -0.5 : 0.5;
  const Eigen::Vector3d from_eye = 1e-3 * Eigen::Vector3d(side, -3.5, 0.5) - camera.eye;
  const double scale = 180.0 / std::tan(0.5 * camera.field_of_view) / from_eye.dot(forward);
  EXPECT_NEAR(placed[0].pixel.x(), 320.0 + scale * from_eye.dot(right), 1e-6);
  EXPECT_NEAR(placed[0].pixel.y(), 180.0 - scale * from_eye.dot(right.cross(forward)), 1e-6);
  d.simulator.camera.start.target.x() += 0.2;
  EXPECT_FALSE(placed_structures(d, *d.bones.front(), 640, 360)[0].in_sight);
}

TEST(PlacementPictureTest, WordsOfAxesLieOnLinesOfTheirOwn) {
  std::array<Eigen::Vector2d, 3> words{{{40.0, 52.0}, {44.0, 50.0}, {100.0, 51.0}}};
  set_words_apart(words, 10.0, 30.0);
  EXPECT_EQ(words[1], Eigen::Vector2d(44.0, 50.0));
  EXPECT_EQ(words[0], Eigen::Vector2d(40.0, 60.0));
  EXPECT_EQ(words[2], Eigen::Vector2d(100.0, 51.0)) << "nothing is near it";
}

TEST(PlacementPictureTest, TheCavityIsRedAndNothingElse) {
  const render::Image without = placement_picture(placed_slabs(false), 0);
  const render::Image with = placement_picture(placed_slabs(true), 0);
  ASSERT_EQ(with.width, 640);
  ASSERT_EQ(with.height, 360);
  EXPECT_EQ(red_pixels(without), 0);
  EXPECT_GT(red_pixels(with), 300);
}

TEST(PlacementPictureTest, TheWordsSayWhatIsKnownOfTheSide) {
  BoneDefinition d = placed_slabs(false);
  EXPECT_THAT(placement_words(d, *d.bones.front()), testing::HasSubstr("no side is known"));
  d.mirror = true;
  d.placement.left_ear = true;
  EXPECT_THAT(placement_words(d, *d.bones.front()),
              testing::HasSubstr("left and right exchanged by mirror = true; placed as a surgeon "
                                 "sees a left ear"));
}

}  // namespace
}  // namespace haptrial::protocols
