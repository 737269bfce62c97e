#include "core/render/mesh/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/voxelize.h"
#include "core/render/mesh/mesh_scene.h"

namespace haptrial::render::scene_test {
namespace {

using Pixel = std::array<int, 3>;

Pixel at(const Image& image, int x, int y) {
  const std::size_t first =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x));
  return {image.rgb[first], image.rgb[first + 1], image.rgb[first + 2]};
}

double share_drawn(const Image& image) {
  double drawn = 0.0;
  for (std::size_t p = 0; p < image.rgb.size(); p += 3) {
    drawn += image.rgb[p] != 255 || image.rgb[p + 1] != 255 || image.rgb[p + 2] != 255;
  }
  return 3.0 * drawn / static_cast<double>(image.rgb.size());
}

/// A view along -z with y up.
SceneView from_z() {
  SceneView view;
  view.azimuth = 0.0;
  view.elevation = 0.0;
  view.width = 200;
  view.height = 100;
  return view;
}

SceneTriangle triangle(double z, double size, const Colour& colour) {
  return {{Eigen::Vector3d(-size, -size, z), Eigen::Vector3d(size, -size, z),
           Eigen::Vector3d(0, size, z)},
          colour};
}

TEST(SceneTest, TheViewTurnsAroundUp) {
  SceneView view = from_z();
  EXPECT_TRUE(view.towards_eye().isApprox(Eigen::Vector3d::UnitZ()));
  view.azimuth = M_PI / 2;
  EXPECT_TRUE(view.towards_eye().isApprox(Eigen::Vector3d::UnitX()));
  view.elevation = M_PI / 6;
  EXPECT_NEAR(view.towards_eye().y(), 0.5, 1e-12);
  EXPECT_NEAR(view.towards_eye().norm(), 1.0, 1e-12);
  view.up = 3.0 * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(view.towards_eye().z(), 0.5, 1e-12);
}

TEST(SceneTest, WhatIsNearerTheEyeHidesWhatIsBehindInAnyOrder) {
  const SceneTriangle red = triangle(0.0, 1.0, {1, 0, 0});
  const SceneTriangle small_green = triangle(0.5, 0.5, {0, 1, 0});
  for (const auto& scene : {std::vector{red, small_green}, std::vector{small_green, red}}) {
    const Image image = draw_scene(scene, from_z());
    ASSERT_EQ(image.width, 200);
    EXPECT_EQ(at(image, 100, 50), (Pixel{0, 255, 0})) << "faces the eye: full light";
    EXPECT_EQ(at(image, 100, 90), (Pixel{255, 0, 0}));
    EXPECT_EQ(at(image, 5, 5), (Pixel{255, 255, 255}));
  }
  SceneView behind = from_z();
  behind.azimuth = M_PI;
  EXPECT_EQ(at(draw_scene(std::vector{red, small_green}, behind), 100, 50), (Pixel{255, 0, 0}));
}

TEST(SceneTest, ASceneFillsThePictureAndASlantIsDarker) {
  const Image image = draw_scene(scene_of(geometry::make_sphere(3.0, 20), {1, 1, 0}), from_z());
  // A disc of the picture's height less the margin.
  EXPECT_NEAR(share_drawn(image), M_PI / 4.0 * 0.5 / (1.06 * 1.06), 0.02);
  EXPECT_GT(at(image, 100, 50)[0], 250);
  EXPECT_LT(at(image, 100, 8)[0], 180) << "near the rim";
  EXPECT_EQ(at(image, 100, 50)[2], 0);
}

TEST(SceneTest, EdgesAreDrawnWhereAsked) {
  SceneView view = from_z();
  const std::vector scene{triangle(0.0, 1.0, {1, 1, 1})};
  const auto darkest = [&] {
    const Image image = draw_scene(scene, view);
    return *std::min_element(image.rgb.begin(), image.rgb.end());
  };
  EXPECT_EQ(darkest(), 255);
  view.edges = true;
  EXPECT_LT(darkest(), 160);
  // A square of two triangles without the diagonal between them.
  const std::array<Eigen::Vector3d, 4> c{Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, -1, 0),
                                         Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(-1, 1, 0)};
  const Colour white{1, 1, 1};
  const std::vector<SceneTriangle> square{{{c[0], c[1], c[2]}, white, 1},
                                          {{c[0], c[2], c[3]}, white, 2}};
  EXPECT_EQ(at(draw_scene(square, view), 100, 50), (Pixel{255, 255, 255}));
}

TEST(SceneTest, ACutShowsTheInnerVoxelsRed) {
  const geometry::Mesh sphere = geometry::make_sphere(1.0, 12);
  const geometry::VoxelSolid solid = geometry::voxelize(
      sphere, geometry::make_grid(geometry::bounds(sphere), 20), geometry::InsideRule::kParity);
  const SceneView view = from_z();
  const Image whole = draw_scene(scene_of(solid), view);
  const Image half = draw_scene(scene_of(solid, halfway(geometry::bounds(sphere), view)), view);
  EXPECT_GT(at(whole, 100, 50)[1], at(whole, 100, 50)[0]) << "green";
  EXPECT_GT(at(half, 100, 50)[0], at(half, 100, 50)[1]) << "red";
  EXPECT_NEAR(share_drawn(whole), share_drawn(half), 0.01) << "the same outline";

  const geometry::TetMesh tets = geometry::tetrahedralize(solid);
  const auto faces = scene_of(tets);
  const auto sides = scene_of(solid);
  EXPECT_EQ(faces.size(), sides.size()) << "two triangles to every exposed side of a voxel";
}

TEST(SceneTest, NothingOrNotANumberIsRefused) {
  EXPECT_THROW(draw_scene({}, from_z()), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(draw_scene(std::vector{triangle(nan, 1.0, {1, 1, 1})}, from_z()),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::render::scene_test
