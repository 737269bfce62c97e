// The border of a bone that was read as voxels is a surface without terraces.

#include "core/bone/surface/border_shares.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/bone/surface/surface.h"

namespace haptrial::bone::border_shares_test {
namespace {

constexpr double kSpacing = 0.5e-3;

/// Voxels whose centres lie below a height, z = height(x, y) [voxels].
template <class Height>
BoneModel below(int side, int deep, const Height& height) {
  BoneModel model;
  model.grid.spacing = kSpacing;
  model.grid.size = {side, side, deep};
  model.structures = {{}, {"bone", {0.9, 0.9, 0.8}, 1.0, false}};
  model.labels.assign(model.grid.count(), 0);
  for (int k = 0; k < deep; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        model.labels[model.grid.index(i, j, k)] = k <= height(i, j) ? 1 : 0;
      }
    }
  }
  return model;
}

struct Errors {
  double place{0.0};   // rms along z [voxels]
  double normal{0.0};  // rms [rad]
  int count{0};
};

/// Errors of the upper side, away from the block's edges.
template <class Height>
Errors errors_of(const BoneModel& model, const Height& height, const Eigen::Vector3d& normal) {
  const BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  Errors found;
  for (const SurfaceVertex& vertex : surface.vertices()) {
    const Eigen::Vector3d at =
        (Eigen::Vector3f(vertex.place.data()).cast<double>() - model.grid.origin) / kSpacing;
    const double edge = 12.0;
    const double size = model.grid.size[0] - 1.0;
    if (at.x() < edge || at.y() < edge || at.x() > size - edge || at.y() > size - edge ||
        vertex.normal[2] < 10000) {
      continue;
    }
    const Eigen::Vector3d n =
        Eigen::Vector3d(vertex.normal[0], vertex.normal[1], vertex.normal[2]).normalized();
    found.place += std::pow(at.z() - height(at.x(), at.y()), 2);
    found.normal += std::pow(std::acos(std::min(1.0, n.dot(normal))), 2);
    ++found.count;
  }
  found.place = std::sqrt(found.place / found.count);
  found.normal = std::sqrt(found.normal / found.count);
  return found;
}

/// A plane that rises by one voxel in sixteen: voxels alone are off by 0.21 voxels and 6 degrees
/// rms.
TEST(BorderSharesTest, AGentleSlopeHasNoTerraces) {
  const auto height = [](double i, double j) { return 8.3 + i / 16.0 + j / 41.0; };
  const Eigen::Vector3d normal = Eigen::Vector3d(-1.0 / 16.0, -1.0 / 41.0, 1.0).normalized();
  const Errors found = errors_of(below(72, 24, height), height, normal);
  ASSERT_GT(found.count, 1000);
  EXPECT_LT(found.place, 0.1);
  EXPECT_LT(found.normal, 0.03);
}

/// Steep planes were right before, and stay so.
TEST(BorderSharesTest, ASteepSlopeStaysWhereItIs) {
  const auto height = [](double i, double j) { return 2.3 + 0.6 * i + 0.35 * j; };
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.6, -0.35, 1.0).normalized();
  const Errors found = errors_of(below(40, 48, height), height, normal);
  ASSERT_GT(found.count, 200);
  EXPECT_LT(found.place * normal.z(), 0.12);
  EXPECT_LT(found.normal, 0.04);
}

/// A flat along the voxels is flat, and a sheet one voxel thick is left alone.
TEST(BorderSharesTest, AFlatAndASheetAreWhole) {
  const auto flat = [](int, int) { return 9.0; };
  for (const int thick : {10, 1}) {
    BoneModel model = below(24, 16, flat);
    for (int k = 0; k < 10 - thick; ++k) {
      for (int j = 0; j < 24; ++j) {
        for (int i = 0; i < 24; ++i) {
          model.labels[model.grid.index(i, j, k)] = 0;
        }
      }
    }
    const BoneVolume volume(model);
    const BorderShares border(volume);
    for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
      for (int row = 0; row < 64; ++row) {
        const std::uint8_t* shares = border.row(brick, row % 8, row / 8);
        for (int x = 0; shares != nullptr && x < 8; ++x) {
          EXPECT_EQ(shares[x], BorderShares::kWhole);
        }
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::bone::border_shares_test
