// Shape of a surface if bone is worn away by parts of voxels, and the surface
// that joins neighbours, to which it is compared.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/bone/drill/drill.h"
#include "core/bone/surface/surface.h"
#include "tests/core/bone/surface/surface_checks.h"
#include "tests/support/references/neighbour_surface.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::drilled_surface_test {
namespace {

using Eigen::Vector3d;

/// Leaves each voxel the share of it that is bone. @param left  by voxel, 0 to 1
template <class Left>
void wear(BoneVolume& volume, Left&& left) {
  const auto& size = volume.grid().size;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const std::int32_t at = volume.address(Voxel(i, j, k));
        const auto rest = static_cast<float>(left(Voxel(i, j, k)));
        if (at != 0 && rest < volume.density(at)) {
          volume.take(at, volume.density(at) - rest);
        }
      }
    }
  }
}

/// Position of a vertex in voxels from the grid's first.
Vector3d in_voxels(const BoneVolume& volume, const SurfaceVertex& vertex) {
  return (place_of(vertex) - volume.grid().origin) / volume.grid().spacing;
}

/// A vertex that is not in use keeps its last place: only those of triangles count.
template <class Visit>
void for_each_corner(const Surface& surface, Visit&& visit) {
  for (const SurfaceTriangle& t : living(surface.triangles())) {
    for (const std::uint32_t v : t) {
      visit(surface.vertices()[v]);
    }
  }
}

TEST(DrilledSurfaceTest, AFlatThatIsWornAwayGoesDownEvenly) {
  BoneVolume volume(model_of(24, [](const Voxel&) { return 1; }));
  Surface surface;
  surface.update(volume);
  for (int step = 0; step <= 48; ++step) {
    const double top = 16.0 - step / 16.0;  // voxel k fills k - 0.5 to k + 0.5
    wear(volume, [&](const Voxel& v) { return std::clamp(top + 0.5 - v.z(), 0.0, 1.0); });
    surface.update(volume);
    int seen = 0;
    for_each_corner(surface, [&](const SurfaceVertex& vertex) {
      const Vector3d at = in_voxels(volume, vertex);
      if ((at - Vector3d(11.5, 11.5, top)).cwiseAbs().maxCoeff() < 4.0) {
        ++seen;
        ASSERT_NEAR(at.z(), top, 0.025) << step << " sixteenths";
        ASSERT_GT(normal_of(vertex).z(), 0.9999) << step << " sixteenths";
      }
    });
    ASSERT_GT(seen, 100) << step << " sixteenths";
  }
}

/// Root mean square of distance and angle.
struct Error {
  double distance{0.0};  // [voxels]
  double farthest{0.0};  // [voxels]
  double angle{0.0};     // [degrees]
};

Error of_ball(const BoneVolume& volume, const Vector3d& centre, double radius) {
  Surface surface;
  surface.update(volume);
  Error sum;
  int count = 0;
  for_each_corner(surface, [&](const SurfaceVertex& vertex) {
    const Vector3d from = in_voxels(volume, vertex) - centre;
    const double off = from.norm() - radius;
    if (std::abs(off) < 3.0) {
      const double cosine = std::min(1.0, -normal_of(vertex).dot(from.normalized()));
      ++count;
      sum.distance += off * off;
      sum.farthest = std::max(sum.farthest, std::abs(off));
      sum.angle += std::pow(std::acos(cosine) * 180.0 / std::numbers::pi, 2);
    }
  });
  EXPECT_GT(count, 1000);
  return {std::sqrt(sum.distance / count), sum.farthest, std::sqrt(sum.angle / count)};
}

/// The same bone as if each voxel with anything left were whole.
BoneVolume by_whole_voxels(const BoneVolume& volume) {
  BoneModel model = model_of(volume.grid().size[0],
                             [&](const Voxel& v) { return volume.density(v) > 0.0F ? 1 : 0; });
  model.grid = volume.grid();
  return BoneVolume(model);
}

TEST(DrilledSurfaceTest, ABallThatIsWornIntoABlockIsRound) {
  const Vector3d centre(23.3, 23.1, 23.6);
  constexpr double kRadius = 13.3;
  BoneVolume volume(model_of(48, [](const Voxel&) { return 1; }));
  wear(volume, [&](const Voxel& v) {
    constexpr int kParts = 8;
    int outside = 0;
    for (int part = 0; part < kParts * kParts * kParts; ++part) {
      const Vector3d in(part % kParts, part / kParts % kParts, part / kParts / kParts);
      const Vector3d at = v.cast<double>() + ((in.array() + 0.5) / kParts - 0.5).matrix();
      outside += (at - centre).norm() > kRadius;
    }
    return outside / std::pow(kParts, 3);
  });
  const Error now = of_ball(volume, centre, kRadius);
  const Error whole = of_ball(by_whole_voxels(volume), centre, kRadius);
  // Smoothing with variance 1 puts it 1 / R off.
  EXPECT_LT(now.distance, 1.5 / kRadius);
  EXPECT_LT(now.farthest, 3.0 / kRadius);
  EXPECT_LT(now.angle, 0.5);
  EXPECT_LT(now.distance, 0.5 * whole.distance);
}

/// How uneven a patch that looks upwards is.
struct Roughness {
  double height{0.0};  // off the nearest paraboloid, rms [voxels]
  double angle{0.0};   // between the normals and the paraboloid's, rms [degrees]
};

Roughness roughness(const BoneVolume& volume, const Eigen::Vector2d& half) {
  Surface surface;
  surface.update(volume);
  std::vector<Vector3d> places, normals;
  const Vector3d middle = 0.5 * Vector3d::Constant(volume.grid().size[0] - 1);
  for_each_corner(surface, [&](const SurfaceVertex& vertex) {
    const Vector3d at = in_voxels(volume, vertex) - middle;
    const bool within = std::abs(at.x()) < half.x() && std::abs(at.y()) < half.y();
    if (within && normal_of(vertex).z() > 0.3) {
      places.push_back(at);
      normals.push_back(normal_of(vertex));
    }
  });
  EXPECT_GT(places.size(), 300U);
  Eigen::MatrixXd a(places.size(), 6);
  Eigen::VectorXd b(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = places[i].x(), y = places[i].y();
    const auto row = static_cast<Eigen::Index>(i);
    a.row(row) << 1.0, x, y, x * x, x * y, y * y;
    b[row] = places[i].z();
  }
  const Eigen::VectorXd c = a.householderQr().solve(b);
  const auto count = static_cast<double>(places.size());
  double angles = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = places[i].x(), y = places[i].y();
    const Vector3d up(-(c[1] + 2.0 * c[3] * x + c[4] * y), -(c[2] + c[4] * x + 2.0 * c[5] * y), 1);
    const double cosine = std::min(1.0, up.normalized().dot(normals[i]));
    angles += std::pow(std::acos(cosine) * 180.0 / std::numbers::pi, 2);
  }
  return {(a * c - b).norm() / std::sqrt(count), std::sqrt(angles / count)};
}

/// A stroke along x over flat bone, slantwise down, that leaves most voxels at its floor in part.
TEST(DrilledSurfaceTest, AStrokeOfABurrLeavesNoTerraces) {
  constexpr double kSpacing = 0.3e-3;
  BoneVolume bone(test::flat_bone(60, kSpacing));  // its surface is at z = 0
  Drill drill(for_bone(default_burr(BurrKind::kDiamond, 6e-3), kSpacing), {});
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));
  for (int tick = 0; tick < 400; ++tick) {
    const double x = -6e-3 + 3e-5 * tick;  // 30 mm/s
    drill.begin_tick();
    const Contact contact = drill.touch(bone, {x, 0.0, 2e-3 - 0.03 * x}, lying);
    drill.remove(bone, contact, 2.0, 1.0, 1e-3);
  }
  const Eigen::Vector2d patch(8.0, 3.0);
  const Roughness now = roughness(bone, patch);
  const Roughness whole = roughness(by_whole_voxels(bone), patch);
  EXPECT_LT(now.height, 0.5 * whole.height);
  EXPECT_LT(now.angle, 0.7 * whole.angle);
}

TEST(DrilledSurfaceTest, ACrumbIsDrawnHoweverLittleIsLeftOfIt) {
  BoneVolume volume(model_of(16, [](const Voxel& v) { return v == Voxel(8, 8, 8) ? 1 : 0; }));
  Surface surface;
  wear(volume, [](const Voxel&) { return 0.01; });
  surface.update(volume);
  EXPECT_EQ(surface.triangle_count(), 12U);
}

/// Colours are those of the bone, not of what the burr has taken.
TEST(DrilledSurfaceTest, ItsDensityIsThatOfTheBoneBeforeItWasDrilled) {
  BoneModel model = ball_model(20, 6.0);
  for (const std::uint8_t label : model.labels) {
    model.density.push_back(label == 0 ? 0.0F : 0.6F);
  }
  BoneVolume volume(model);
  Surface surface;
  wear(volume, [](const Voxel& v) { return v.x() > 12 ? 0.25 : 1.0; });
  surface.update(volume);
  for_each_corner(surface, [](const SurfaceVertex& vertex) {
    EXPECT_EQ(vertex.density, 153);  // 0.6 of 255
  });
}

}  // namespace
}  // namespace haptrial::bone::drilled_surface_test

namespace haptrial::bone {
namespace {

std::vector<SurfaceTriangle> triangles_of(const geometry::Mesh& mesh) {
  std::vector<SurfaceTriangle> all;
  for (const geometry::Triangle& t : mesh.triangles) {
    all.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                   static_cast<std::uint32_t>(t[2])});
  }
  return all;
}

TEST(NeighbourSurfaceTest, FourVoxelsMakeATetrahedronOrASquareTwice) {
  const auto made = [](auto&& label_of) {
    return triangles_of(NeighbourSurface(BoneVolume(model_of(8, label_of))).mesh());
  };
  const auto corner = made([](const Voxel& v) {
    const Voxel d = v - Voxel::Constant(3);
    return d.minCoeff() >= 0 && d.sum() <= 1;
  });
  EXPECT_EQ(corner.size(), 4U);
  EXPECT_EQ(open_edges(corner), 0);
  // Cost of the exhaustive way: all four triangles of three of a square's corners.
  const auto square = made([](const Voxel& v) {
    return v.z() == 3 && (v.x() == 3 || v.x() == 4) && (v.y() == 3 || v.y() == 4);
  });
  EXPECT_EQ(square.size(), 4U);
}

TEST(NeighbourSurfaceTest, OfABallItsTrianglesOverlapWhereOneVertexToACellIsClosed) {
  const BoneVolume volume(ball_model(24, 9.0));
  const NeighbourSurface theirs(volume);
  Surface ours;
  ours.update(volume);
  EXPECT_GT(branching_edges(triangles_of(theirs.mesh())), 0);
  EXPECT_EQ(branching_edges(ours.triangles()), 0);
}

}  // namespace
}  // namespace haptrial::bone
