#include "analysis/bone_drilling/report/visibility_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "core/bone/data/anatomy.h"
#include "core/render/gl/image.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

double area(const render::SceneTriangle& t) {
  return 0.5 * (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).norm();
}

/// Areas of the triangles in which red, green or blue is the strongest: hidden voxels, seen ones,
/// the vein [mm^2].
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

TEST(VisibilityPictureTest, GreenMagentaAndStructuresHaveTheSurfacesOfTheirVoxels) {
  const bone::BoneModel model = with_vein();
  const std::vector<std::uint32_t> removed{index(model, 0, 0, 0), index(model, 1, 0, 0),
                                           index(model, 3, 1, 1)};
  const std::vector<std::uint8_t> seen{1, 1, 0};
  const auto triangles = visibility_scene({&model, removed, seen}, vital_labels(model));
  // Two green cubes side by side have 10 sides, one magenta has 6, the vein 6; bone is not drawn.
  EXPECT_TRUE(areas(triangles).isApprox(Eigen::Vector3d(6.0, 10.0, 6.0), 1e-9));
  EXPECT_TRUE(areas(visibility_scene({&model, removed, seen}, {}))
                  .isApprox(Eigen::Vector3d(6.0, 10.0, 0.0), 1e-9));
}

TEST(VisibilityPictureTest, TheSurfaceIsClosedAndInItsPlace) {
  const bone::BoneModel model = with_vein();
  const std::vector<std::uint32_t> removed{index(model, 2, 1, 1)};
  const std::vector<std::uint8_t> seen{1};
  Eigen::AlignedBox3d box;
  for (const auto& t : visibility_scene({&model, removed, seen}, {})) {
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
  EXPECT_THROW(visibility_scene({&model, removed, seen}, {}), std::invalid_argument);
  EXPECT_THROW(visibility_scene({&model, removed, none}, {}), std::invalid_argument);
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

/// A procedure that drills from the top down: on the right a saucer; on the left a shaft, and from
/// its bottom a cave to the left under 4 mm of bone that stays.
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

TEST(VisibilityPictureTest, ASaucerIsSeenAndACaveUnderAShelfIsHidden) {
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
}

/// Whether a pixel has this colour.
bool is(const render::Image& image, int x, int y, const render::Colour& colour) {
  const auto* c =
      image.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x));
  return std::abs(c[0] - 255.0 * colour.red) < 1.0 && std::abs(c[1] - 255.0 * colour.green) < 1.0 &&
         std::abs(c[2] - 255.0 * colour.blue) < 1.0;
}

/// Pixels of a colour: how many, and their middle.
struct Patch {
  int pixels{0};
  double x{0.0}, y{0.0};
};

template <class Chosen>
Patch patch(const render::Image& image, Chosen chosen) {
  Patch p;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (chosen(x, y)) {
        ++p.pixels;
        p.x += x;
        p.y += y;
      }
    }
  }
  p.x /= p.pixels;
  p.y /= p.pixels;
  return p;
}

TEST(VisibilityPictureTest, TheSectionShowsTheShelfOverTheCave) {
  StudyBones study;
  const Procedure p = saucer_and_cave();
  const ProcedureSummary summary = summarize(p, {}, study);
  const SeenRemovals removals{p.bone.get(), summary.removed, summary.removed_seen};
  const render::Image image =
      visibility_section(removals, Eigen::Vector3d(0.1, 0.2, 0.9), 600, 400);
  const auto hidden = [&](int x, int y) { return is(image, x, y, kHiddenColour); };
  const auto seen = [&](int x, int y) { return is(image, x, y, kSeenColour); };
  // All 60 voxels of x are in the picture, 10 pixels each. A layer along x or y: that across x
  // cuts 13 x 9 hidden voxels, that across y 14 x 9.
  const Patch cave = patch(image, hidden);
  EXPECT_EQ(cave.pixels, 14 * 9 * 100);
  // The cave reaches from x = 3 to 16 and z = 12 to 20 of 30 layers that fill 300 of 400 pixels, z
  // upwards.
  EXPECT_NEAR(cave.x, 100.0, 1.0);
  EXPECT_NEAR(cave.y, 350.0 - 10.0 * 16.5, 1.0);
  int over = 0;
  for (int y = static_cast<int>(cave.y); y >= 0 && !is(image, 100, y, {1.0, 1.0, 1.0}); --y) {
    over += hidden(100, y) || seen(100, y) ? 0 : 1;
  }
  EXPECT_EQ(over, 9 * 10) << "layers 21 to 29 of bone stand over the cave";
  EXPECT_GT(patch(image, seen).pixels, 9 * 18 * 100);
  // From below the picture is upside down.
  const render::Image below = visibility_section(removals, -Eigen::Vector3d::UnitZ(), 600, 400);
  const Patch turned = patch(below, [&](int x, int y) { return is(below, x, y, kHiddenColour); });
  EXPECT_EQ(turned.pixels, cave.pixels);
  EXPECT_NEAR(turned.y, 50.0 + 10.0 * 16.5, 1.0);
  EXPECT_THROW(visibility_section({p.bone.get(), {}, {}}, Eigen::Vector3d::UnitZ(), 600, 400),
               std::invalid_argument);
}

TEST(VisibilityPictureTest, TheFigureLooksFromTheEyeAndIsUpright) {
  StudyBones study;
  const Procedure p = saucer_and_cave();
  const ProcedureSummary summary = summarize(p, {}, study);
  const SeenRemovals removals{p.bone.get(), summary.removed, summary.removed_seen};
  // Pixels on the left half; the voxels are shaded, so by which channels are strong.
  const auto strong = [](const render::Image& image, bool hidden) {
    return patch(image, [&image, hidden](int x, int y) {
      const auto* c = image.rgb.data() +
                      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x));
      const int green = c[1] - std::max(c[0], c[2]);
      const int magenta = std::min(c[0], c[2]) - c[1];
      return x < image.width / 2 && (hidden ? magenta : green) > 40;
    });
  };
  // From above with y up in the picture: the cave is on the left; with x up it is below.
  const render::Image image = visibility_figure(
      removals, {Eigen::Vector3d(0.0, -0.3, 1.0), Eigen::Vector3d(0.0, 1.0, 0.1)});
  EXPECT_GT(strong(image, true).pixels, 2000);
  EXPECT_GT(strong(image, false).pixels, 2000);
  EXPECT_LT(strong(image, true).x, strong(image, false).x - 50.0);
  const render::Image turned =
      visibility_figure(removals, {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()});
  EXPECT_GT(strong(turned, true).y, strong(turned, false).y + 50.0);
  if (const char* folder = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    render::write_png(std::filesystem::path(folder) / "drilling-visibility.png", image);
  }
}

double apart(const render::Colour& a, const std::array<double, 3>& b) {
  return std::hypot(a.red - b[0], a.green - b[1], a.blue - b[2]);
}

TEST(VisibilityPictureTest, NoStructureHasTheColoursOfRemovedVoxels) {
  bone::BoneModel model = test::block(5, 4, 3);
  model.structures = bone::known_structures();
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    const auto at = static_cast<int>(label);
    test::mark(model, {at % 5, at / 5 % 4, at / 20}, static_cast<std::uint8_t>(label));
  }
  std::set<std::array<double, 3>> colours;
  for (const auto& t : visibility_scene({&model, {}, {}}, std::vector<bool>(19, true))) {
    colours.insert({t.colour.red, t.colour.green, t.colour.blue});
  }
  EXPECT_GT(colours.size(), 10u);
  for (const auto& colour : colours) {
    EXPECT_GT(apart(kSeenColour, colour), 0.35);
    EXPECT_GT(apart(kHiddenColour, colour), 0.35);
  }
}

}  // namespace
}  // namespace haptrial::analysis::drilling
