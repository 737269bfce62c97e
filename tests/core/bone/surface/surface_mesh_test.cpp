#include "core/bone/surface/surface_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numbers>

#include "tests/support/solid_bone.h"

namespace haptrial::bone {
namespace {

/// Volume by the divergence theorem; above 0 if triangles face outwards.
double volume_of(const geometry::Mesh& mesh) {
  double sum = 0.0;
  for (const geometry::Triangle& t : mesh.triangles) {
    const auto corner = [&](std::size_t c) {
      return mesh.vertices[static_cast<std::size_t>(t[c])];
    };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6.0;
  }
  return sum;
}

/// Whether each edge is run along as often one way as the other.
bool is_closed(const geometry::Mesh& mesh) {
  std::map<std::pair<int, int>, int> ways;
  for (const geometry::Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = t[c];
      const int b = t[(c + 1) % 3];
      ways[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, sum] : ways) {
    if (sum != 0) {
      return false;
    }
  }
  return true;
}

constexpr double kBall = 8e-3;  // [m]

BoneModel ball_with_core() {
  BoneModel model = haptrial::test::solid_bone(
      40, 0.5e-3, [](const Eigen::Vector3d& p) { return p.norm() < kBall; });
  model.structures.push_back({"core"});
  std::size_t at = 0;
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i, ++at) {
        model.labels[at] = model.grid.centre(i, j, k).norm() < 0.5 * kBall ? 2 : model.labels[at];
      }
    }
  }
  return model;
}

TEST(SurfaceMeshTest, ABallHasItsVolumeAndIsClosed) {
  const geometry::Mesh mesh = surface_mesh(BoneVolume(ball_with_core()));
  const double exact = 4.0 / 3.0 * std::numbers::pi * kBall * kBall * kBall;
  EXPECT_NEAR(volume_of(mesh), exact, 0.02 * exact);
  EXPECT_TRUE(is_closed(mesh));
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.norm(), kBall, 0.4e-3);
  }
}

TEST(SurfaceMeshTest, AStructureHasASurfaceOfItsOwn) {
  const geometry::Mesh mesh = structure_mesh(ball_with_core(), 2);
  const double exact = 4.0 / 3.0 * std::numbers::pi * 0.125 * kBall * kBall * kBall;
  EXPECT_NEAR(volume_of(mesh), exact, 0.05 * exact);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_TRUE(structure_mesh(ball_with_core(), 3).triangles.empty());
}

TEST(SurfaceMeshTest, WhatIsDrilledAwayIsMissing) {
  BoneVolume volume(ball_with_core());
  const double before = volume_of(surface_mesh(volume));
  for (int k = 0; k < 20; ++k) {  // the lower half
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) {
        const std::int32_t at = volume.address({i, j, k});
        if (at != 0) {
          volume.take(at, 1.0F);
        }
      }
    }
  }
  EXPECT_NEAR(volume_of(surface_mesh(volume)), 0.5 * before, 0.02 * before);
}

}  // namespace
}  // namespace haptrial::bone
