#include "analysis/drilling/visibility_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

double area(const render::SceneTriangle& t) {
  return 0.5 * (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).norm();
}

/// Of the triangles in which red, green or blue is the strongest [mm^2].
Eigen::Vector3d areas(const std::vector<render::SceneTriangle>& triangles) {
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (const render::SceneTriangle& t : triangles) {
    Eigen::Index strongest = 0;
    Eigen::Vector3d(t.colour.red, t.colour.green, t.colour.blue).maxCoeff(&strongest);
    sums[strongest] += 1e6 * area(t);
  }
  return sums;
}

bone::BoneModel with_vein() {
  bone::BoneModel model = test::block(5, 4, 3);
  model.structures.push_back({"vein", {0.2, 0.3, 0.9}, 1.0, true});
  test::mark(model, {4, 3, 2}, 2);
  return model;
}

std::uint32_t index(const bone::BoneModel& model, int i, int j, int k) {
  return static_cast<std::uint32_t>(model.grid.index(i, j, k));
}

TEST(VisibilityPictureTest, GreenRedAndStructuresHaveTheSurfacesOfTheirVoxels) {
  const bone::BoneModel model = with_vein();
  const std::vector<std::uint32_t> removed{index(model, 0, 0, 0), index(model, 1, 0, 0),
                                           index(model, 3, 1, 1)};
  const std::vector<std::uint8_t> seen{1, 1, 0};
  const auto triangles = visibility_scene(model, removed, seen, vital_labels(model));
  // Two green cubes side by side have 10 sides, one red has 6, the vein 6; bone is not drawn.
  EXPECT_TRUE(areas(triangles).isApprox(Eigen::Vector3d(6.0, 10.0, 6.0), 1e-9));
  EXPECT_TRUE(areas(visibility_scene(model, removed, seen, {}))
                  .isApprox(Eigen::Vector3d(6.0, 10.0, 0.0), 1e-9));
}

TEST(VisibilityPictureTest, TheSurfaceIsClosedAndInItsPlace) {
  const bone::BoneModel model = with_vein();
  const std::vector<std::uint32_t> removed{index(model, 2, 1, 1)};
  const std::vector<std::uint8_t> seen{1};
  Eigen::AlignedBox3d box;
  for (const auto& t : visibility_scene(model, removed, seen, {})) {
    for (const Eigen::Vector3d& corner : t.corners) {
      box.extend(corner);
    }
  }
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(1.5e-3, 0.5e-3, 0.5e-3)));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(2.5e-3, 1.5e-3, 1.5e-3)));
}

TEST(VisibilityPictureTest, RefusesWhatDoesNotFit) {
  const bone::BoneModel model = with_vein();
  const std::vector<std::uint32_t> removed{60};
  const std::vector<std::uint8_t> seen{1}, none;
  EXPECT_THROW(visibility_scene(model, removed, seen, {}), std::invalid_argument);
  EXPECT_THROW(visibility_scene(model, removed, none, {}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
