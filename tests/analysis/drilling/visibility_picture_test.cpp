#include "analysis/drilling/visibility_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "analysis/drilling/metrics.h"
#include "core/render/image.h"
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

/// 30 x 20 x 15 mm of bone over a vein that runs along y under its left half.
bone::BoneModel bone_over_vein() {
  bone::BoneModel model = test::block(60, 40, 30);
  model.grid.spacing = 0.5e-3;
  model.structures.push_back({"sigmoid sinus", {0.25, 0.35, 0.85}, 1.0, true});
  for (int j = 0; j < 40; ++j) {
    for (int i = 0; i < 60; ++i) {
      for (int k = 0; k < 30; ++k) {
        if (std::hypot(i - 10.0, k - 6.0) <= 4.0) {
          test::mark(model, {i, j, k}, 2);
        }
      }
    }
  }
  return model;
}

/// From the top down: on the right a saucer; on the left a shaft, and from its bottom a cave to the
/// left under 4 mm of bone that stays.
Procedure saucer_and_cave() {
  Procedure p = test::procedure_on(bone_over_vein());
  p.tools[0].burr_radius = 1e-3;
  p.views = {{0, {15e-3, 10e-3, 0.25}, {15e-3, 10e-3, 0.0}}};
  for (int k = 29; k >= 12; --k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 60; ++i) {
        const bool saucer = std::hypot(i - 44.0, j - 20.0, 1.3 * (k - 31.0)) < 15.0;
        const bool shaft = std::abs(i - 21) <= 4 && std::abs(j - 20) <= 6;
        const bool cave = k <= 20 && i >= 3 && i < 17 && std::abs(j - 20) <= 6;
        if (saucer || shaft || cave) {
          test::remove_in_turn(p, {{i, j, k}});
        }
      }
    }
  }
  return p;
}

TEST(VisibilityPictureTest, ASaucerIsGreenAndACaveUnderAShelfIsRed) {
  StudyBones study;
  const Procedure p = saucer_and_cave();
  const ProcedureSummary summary = summarize(p, {}, study);
  const std::size_t row = 60;
  int cave_seen = 0;
  int cave_hidden = 0;
  for (std::size_t n = 0; n < summary.removed.size(); ++n) {
    const std::size_t i = summary.removed[n] % row;
    if (i >= 17) {
      EXPECT_EQ(summary.removed_seen[n], 1) << "of the saucer or the shaft";
    } else {
      (summary.removed_seen[n] != 0 ? cave_seen : cave_hidden) += 1;
    }
  }
  // Rays to the eye lean by less than half a voxel on their way up: the shelf is over all of it.
  EXPECT_EQ(cave_hidden, 14 * 13 * 9);
  EXPECT_EQ(cave_seen, 0);
  const auto triangles =
      visibility_scene(*p.bone, summary.removed, summary.removed_seen, vital_labels(*p.bone));
  render::SceneView view;
  view.up = Eigen::Vector3d::UnitZ();
  view.azimuth = -1.0;
  view.elevation = 0.3;
  const render::Image image = render::draw_scene(triangles, view);
  std::array<int, 3> strongest{};
  for (std::size_t at = 0; at < image.rgb.size(); at += 3) {
    const auto* c = image.rgb.data() + at;
    const int most = std::max({c[0], c[1], c[2]});
    if (most - std::min({c[0], c[1], c[2]}) > 40) {
      ++strongest[static_cast<std::size_t>(std::find(c, c + 3, most) - c)];
    }
  }
  for (const int pixels : strongest) {
    EXPECT_GT(pixels, 2000);
  }
  if (const char* folder = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    render::write_png(std::filesystem::path(folder) / "drilling-visibility.png", image);
  }
}

}  // namespace
}  // namespace haptrial::analysis::drilling
