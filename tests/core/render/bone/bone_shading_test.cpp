// Light that is kept off: none on what lies open, more the deeper a pit is, and a tool's shadow
// where the lamp's direction puts it.
#include "core/render/bone/bone_shading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/bone/surface/surface_depths.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/gl/offscreen.h"
#include "tests/core/bone/surface/surface_checks.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render::bone_shading_test {
namespace {

using bone::BoneModel;
using bone::BoneVolume;
using bone::Voxel;

constexpr int kSize = 48;  // voxels of the slab
constexpr int kTop = 24;   // its uppermost layer
constexpr int kWidth = 240;
constexpr int kHeight = 180;
constexpr double kDistance = 0.3;  // of the eye [m]
constexpr double kFieldOfView = 0.35;

/// A slab with a square pit in its middle, seen from above.
BoneModel slab(int pit_depth, int pit_half_width) {
  return bone::model_of(kSize, [=](const Voxel& v) {
    const bool pit = std::abs(v.x() - kSize / 2) <= pit_half_width &&
                     std::abs(v.y() - kSize / 2) <= pit_half_width && v.z() > kTop - pit_depth;
    const bool inside = v.minCoeff() >= 2 && v.x() < kSize - 2 && v.y() < kSize - 2;
    return inside && v.z() <= kTop && !pit ? 1 : 0;
  });
}

struct Picture {
  Picture(const BoneModel& model, const BoneStyle& style, const std::vector<SceneMesh>& tools = {})
      : volume(model), context(kWidth, kHeight) {
    const geometry::VoxelGrid& grid = model.grid;
    frame.camera.target = grid.centre(kSize / 2, kSize / 2, kTop);
    frame.camera.eye = frame.camera.target + Eigen::Vector3d(0, 0, kDistance);
    frame.camera.field_of_view = kFieldOfView;
    frame.bones = {{1, &volume, Eigen::Isometry3d::Identity()}};
    frame.meshes = tools;
    BoneScene scene(
        context.gl(), style, model.structures,
        std::make_shared<bone::StructureDepths>(model, bone::all_but_bone(model.structures)));
    scene.draw(frame, kWidth, kHeight);
    image = context.read();
  }
  /// Brightness at a place of the slab's face, in m from its middle along the picture.
  double at(double right, double up) const {
    const double pixels = 0.5 * kHeight / std::tan(0.5 * kFieldOfView) / kDistance;
    return pixel(image, static_cast<int>(std::lround(0.5 * kWidth + pixels * right)),
                 static_cast<int>(std::lround(0.5 * kHeight - pixels * up)))
        .sum();
  }
  BoneVolume volume;
  OffscreenContext context;
  BoneFrame frame;
  Image image;
};

BoneStyle without() {
  BoneStyle style;
  style.occlusion = 0.0;
  style.shadow = 0.0;
  return style;
}

constexpr double kVoxel = 0.001;  // [m]

TEST(BoneShadingTest, WhatLiesOpenKeepsItsLight) {
  const BoneModel model = slab(0, 0);
  const Picture plain(model, without());
  const Picture shaded(model, BoneStyle{});
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      EXPECT_DOUBLE_EQ(shaded.at(i * kVoxel, j * kVoxel), plain.at(i * kVoxel, j * kVoxel));
    }
  }
}

TEST(BoneShadingTest, APitsFloorIsDarkerTheDeeperItLies) {
  double last = 1.0;
  for (const int depth : {2, 4, 8}) {
    const BoneModel model = slab(depth, 4);
    const double share =
        Picture(model, BoneStyle{}).at(0.0, 0.0) / Picture(model, without()).at(0.0, 0.0);
    EXPECT_LT(share, last - 0.02) << depth;
    last = share;
  }
  EXPECT_GT(last, 0.2) << "not black";
}

TEST(BoneShadingTest, ABallsShadowLiesWhereTheLampPutsIt) {
  const BoneModel model = slab(0, 0);
  const double radius = 2 * kVoxel;
  const Eigen::Vector3d lamp(0.45, 0.6, 1.0);  // beside the eye
  double last = 0.0;
  for (const double height : {2.5 * kVoxel, 5.0 * kVoxel, 10.0 * kVoxel}) {
    SceneMesh ball{std::make_shared<geometry::Mesh>(plane_mesh(1e-5, 1e-5)),
                   Eigen::Isometry3d::Identity(),
                   {1.0, 0.0, 0.0},
                   {{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), radius}}};
    const Eigen::Vector3d face =
        model.grid.centre(kSize / 2, kSize / 2, kTop) + Eigen::Vector3d(0, 0, 0.5 * kVoxel);
    ball.pose.translation() = face + Eigen::Vector3d(0, 0, height);
    BoneStyle style = without();
    style.shadow = 0.5;
    const Picture lit(model, without(), {ball});
    const Picture dark(model, style, {ball});
    // The mean place of what it takes, weighed by how much.
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double taken = 0.0;
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        const Eigen::Vector2d place = 0.4 * kVoxel * Eigen::Vector2d(i, j);
        const double less = lit.at(place.x(), place.y()) - dark.at(place.x(), place.y());
        EXPECT_GE(less, -1e-9) << "it only takes";
        if (less > 0.2 * lit.at(place.x(), place.y())) {  // more than its nearness does
          sum += less * place;
          taken += less;
        }
      }
    }
    ASSERT_GT(taken, 0.0);
    const Eigen::Vector2d expected = -height * lamp.head<2>() / lamp.z();
    EXPECT_LT((sum / taken - expected).norm(), radius) << height / kVoxel;
    EXPECT_GT((sum / taken).norm(), last) << "the higher, the further off";
    last = (sum / taken).norm();
  }
}

TEST(BoneShadingTest, TheBurrsShadowIsThatOfItsMesh) {
  const geometry::Mesh mesh = burr_mesh(0.006, 0.002, 0.08);
  const std::vector<Capsule> parts = burr_shadow(0.006, 0.002, 0.08);
  const auto outside = [&](const Eigen::Vector3d& place) {
    double least = INFINITY;
    for (const Capsule& part : parts) {
      const Eigen::Vector3d along = part.to - part.from;
      const double length = along.squaredNorm();
      const double share =
          length > 0.0 ? std::clamp(along.dot(place - part.from) / length, 0.0, 1.0) : 0.0;
      least = std::min(least, (place - part.from - share * along).norm() - part.radius);
    }
    return least;
  };
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    EXPECT_LT(outside(vertex), 1e-9) << vertex.transpose();
  }
}

}  // namespace
}  // namespace haptrial::render::bone_shading_test
