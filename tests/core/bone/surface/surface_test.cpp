#include "core/bone/surface/surface.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::bone {
namespace {

/// Densities, labels and a nerve inside: everything that a vertex carries.
BoneModel rich_model(int size, std::uint64_t seed) {
  RandomStream random(seed, "rich");
  BoneModel model = ball_model(size, 0.42 * size);
  model.density.assign(model.labels.size(), 0.0F);
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    if (model.labels[at] != 0) {
      model.labels[at] = random.uniform() < 0.1 ? 2 : 1;
      model.density[at] = static_cast<float>(random.uniform(0.2, 1.0));
    }
  }
  return model;
}

void empty(BoneVolume& volume, const Voxel& voxel) {
  if (const std::int32_t at = volume.address(voxel); at != 0) {
    volume.take(at, 1.0F);
  }
}

template <class Visit>
void for_each_voxel(const geometry::VoxelGrid& grid, Visit&& visit) {
  geometry::visit_voxels(grid, [&](const Voxel& voxel, std::size_t) { visit(voxel); });
}

/// Something that changes a volume somewhere, as seeded.
void carve(BoneVolume& volume, RandomStream& random) {
  const int size = volume.grid().size[0];
  const auto somewhere = [&] {
    return Eigen::Vector3d(random.uniform(0, size), random.uniform(0, size),
                           random.uniform(0, size));
  };
  const std::uint64_t kind = random.below(5);
  const Eigen::Vector3d centre = somewhere();
  const Eigen::Vector3d normal = (somewhere() - somewhere()).normalized();
  const double reach = random.uniform(0.5, 0.2 * size);
  const double share = random.uniform(0.0, 0.3);
  for_each_voxel(volume.grid(), [&](const Voxel& voxel) {
    const Eigen::Vector3d from = voxel.cast<double>() - centre;
    const std::int32_t at = volume.address(voxel);
    if (kind == 0 && from.norm() < reach) {
      empty(volume, voxel);
    } else if (kind == 1 && from.norm() < reach && random.uniform() < share) {
      empty(volume, voxel);
    } else if (kind == 2 && std::abs(from.dot(normal)) < 0.8) {
      empty(volume, voxel);
    } else if (kind == 3 && from.norm() < reach && at != 0) {
      volume.take(at, 0.3F);
    } else if (kind == 4 && from.norm() < 0.5 * reach && at != 0 && volume.label(at) != 0) {
      volume.put(at, 0.5F);
    }
  });
}

TEST(SurfaceTest, WhatIsCountedBeforehandIsWhatABuildMakes) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    BoneVolume volume(rich_model(30 + static_cast<int>(seed), seed));
    RandomStream random(seed, "count");
    for (int i = 0; i < 8; ++i) {
      carve(volume, random);
    }
    Surface surface;
    surface.build(volume);
    Occupancy occupancy;
    occupancy.follow(volume);
    std::vector<std::int32_t> bricks(static_cast<std::size_t>(volume.bricks()) - 1);
    std::iota(bricks.begin(), bricks.end(), 1);
    RemainingFraction remains;
    remains.follow(volume, occupancy, bricks, nullptr);
    CellField::Count all;
    CellField field;
    const geometry::VoxelGrid& grid = volume.grid();
    for (int k = -CellField::kEdge; k < grid.size[2]; k += CellField::kEdge) {
      for (int j = -CellField::kEdge; j < grid.size[1]; j += CellField::kEdge) {
        for (int i = -CellField::kEdge; i < grid.size[0]; i += CellField::kEdge) {
          const bool any = field.read(volume, occupancy, remains, {i, j, k});
          const CellField::Count here = any ? field.count() : CellField::Count{};
          all.vertices += here.vertices;
          all.quads += here.quads;
        }
      }
    }
    EXPECT_GT(all.vertices, 100u);
    EXPECT_EQ(all.vertices, surface.vertex_count());
    EXPECT_EQ(2 * all.quads, surface.triangle_count());
  }
}

TEST(SurfaceTest, AfterAnyCarvingItIsClosedAndWhatAFullBuildGives) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RandomStream random(seed, "carving");
    const BoneModel model = rich_model(20 + static_cast<int>(seed), seed);
    const auto depths = std::make_shared<StructureDepths>(model, all_but_bone(model.structures));
    BoneVolume volume(model);
    Surface surface(depths);
    surface.update(volume);
    for (int step = 0; step < 40; ++step) {
      for (std::uint64_t some = 0; some <= random.below(3); ++some) {
        carve(volume, random);
      }
      surface.update(volume);
      Surface fresh(depths);
      fresh.update(volume);
      ASSERT_EQ(open_edges(living(surface.triangles())), 0) << "seed " << seed << " step " << step;
      ASSERT_TRUE(plain(surface) == plain(fresh)) << "seed " << seed << " step " << step;
      ASSERT_EQ(surface.triangle_count(), fresh.triangle_count());
      ASSERT_EQ(surface.vertex_count(), fresh.vertex_count());
    }
    for_each_voxel(volume.grid(), [&](const Voxel& voxel) { empty(volume, voxel); });
    surface.update(volume);
    EXPECT_EQ(surface.triangle_count(), 0U);
    EXPECT_EQ(surface.vertex_count(), 0U);
    EXPECT_TRUE(living(surface.triangles()).empty());
  }
}

/// A nerve deep in a block, taken away while the surface stays as it is.
TEST(SurfaceTest, WhatIsGoneDoesNotShowThroughAndWhatIsLeftDoes) {
  const BoneModel model = model_of(30, [](const Voxel& v) {
    const bool rod = v.y() == 15 && v.z() == 24 && v.x() >= 8 && v.x() < 22;
    return rod ? 2 : v.minCoeff() < 2 || v.maxCoeff() > 27 ? 0 : 1;
  });
  BoneVolume volume(model);
  Surface surface(std::make_shared<StructureDepths>(model, all_but_bone(model.structures), 0.008));
  surface.update(volume);
  const auto over = [&](int x) {
    return surface.vertices()[static_cast<std::size_t>(surface.vertex_of({x, 15, 27}))];
  };
  for (const int x : {8, 15, 20}) {
    EXPECT_EQ(over(x).near_label, 2);
    EXPECT_NEAR(over(x).near_depth * SurfaceVertex::kDepthUnit, 0.003, 1e-4) << "27 - 24 voxels";
  }
  for (int x = 8; x < 16; ++x) {
    empty(volume, {x, 15, 24});
  }
  ASSERT_TRUE(surface.update(volume));
  EXPECT_FALSE(surface.rebuilt());
  EXPECT_EQ(over(20).near_label, 2);
  EXPECT_NEAR(over(20).near_depth * SurfaceVertex::kDepthUnit, 0.003, 1e-4);
  EXPECT_EQ(over(12).near_label, 2) << "the end of the rest";
  EXPECT_NEAR(over(12).near_depth * SurfaceVertex::kDepthUnit, 1e-3 * std::hypot(3, 3), 1.1e-3);
  EXPECT_EQ(over(4).near_label, 0) << "12 voxels from the rest";
  for (int x = 16; x < 22; ++x) {
    empty(volume, {x, 15, 24});
  }
  surface.update(volume);
  for (const SurfaceVertex& vertex : surface.vertices()) {
    EXPECT_EQ(vertex.near_label, 0);
  }
  volume.put(volume.address({15, 15, 24}), 1.0F);  // as a part that comes back
  surface.update(volume);
  EXPECT_EQ(over(15).near_label, 2);
}

TEST(SurfaceTest, ChangedSlotsAreAllThatChanges) {
  RandomStream random(3, "slots");
  const BoneModel model = rich_model(40, 3);
  BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  EXPECT_TRUE(surface.rebuilt());
  EXPECT_FALSE(surface.update(volume)) << "nothing happened";
  std::vector<SurfaceVertex> vertices(surface.vertices().begin(), surface.vertices().end());
  std::vector<SurfaceTriangle> triangles(surface.triangles().begin(), surface.triangles().end());
  for (int step = 0; step < 30; ++step) {
    carve(volume, random);
    surface.update(volume);
    vertices.resize(surface.vertices().size());
    triangles.resize(surface.triangles().size());
    for (const std::int32_t v : surface.changed_vertices()) {
      vertices[static_cast<std::size_t>(v)] = surface.vertices()[static_cast<std::size_t>(v)];
    }
    for (const std::int32_t q : surface.changed_quads()) {
      for (const std::size_t t :
           {2 * static_cast<std::size_t>(q), 2 * static_cast<std::size_t>(q) + 1}) {
        triangles[t] = surface.triangles()[t];
      }
    }
    ASSERT_TRUE(std::equal(vertices.begin(), vertices.end(), surface.vertices().begin()));
    ASSERT_TRUE(std::equal(triangles.begin(), triangles.end(), surface.triangles().begin()));
  }
}

TEST(SurfaceTest, ALittleChangeTouchesLittleWhereverTheBoneEnds) {
  const BoneModel model = ball_model(60, 28.0);
  BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  empty(volume, {30, 30, 57});
  ASSERT_TRUE(surface.update(volume));
  EXPECT_FALSE(surface.rebuilt());
  EXPECT_GT(surface.changed_vertices().size(), 4U);
  EXPECT_LT(surface.changed_vertices().size(), 150U)
      << "6 x 6 x 6 cells at most, few at the surface";
  for (const std::int32_t v : surface.changed_vertices()) {
    EXPECT_LE((surface.cell_of(v) - Voxel(30, 30, 57)).cwiseAbs().maxCoeff(), 5);
  }
}

TEST(SurfaceTest, VerticesAndQuadsAreFoundFromTheirCellsAndVoxels) {
  const BoneModel model = rich_model(24, 9);
  BoneVolume volume(model);
  Surface surface;
  EXPECT_EQ(surface.vertex_of({3, 3, 3}), -1) << "before the first update";
  surface.update(volume);
  std::size_t vertices = 0;
  std::size_t quads = 0;
  const int size = model.grid.size[0];
  for (int k = -2; k <= size; ++k) {
    for (int j = -2; j <= size; ++j) {
      for (int i = -2; i <= size; ++i) {
        const Voxel cell(i, j, k);
        int filled = 0;
        for (int b = 0; b < 8; ++b) {
          filled += volume.density(Voxel(cell + Voxel(b & 1, b >> 1 & 1, b >> 2))) > 0.0F;
        }
        const std::int32_t vertex = surface.vertex_of(cell);
        ASSERT_EQ(vertex >= 0, filled > 0 && filled < 8);
        if (vertex >= 0) {
          ++vertices;
          ASSERT_EQ(surface.cell_of(vertex), cell);
        }
        for (int axis = 0; axis < 3; ++axis) {
          const bool crossed = (volume.density(cell) > 0.0F) !=
                               (volume.density(Voxel(cell + Voxel::Unit(axis))) > 0.0F);
          const std::int32_t quad = surface.quad_of(cell, axis);
          ASSERT_EQ(quad >= 0, crossed);
          if (quad >= 0) {
            ++quads;
            std::set<std::uint32_t> corners;
            for (std::size_t half = 0; half < 2; ++half) {
              const auto& t = surface.triangles()[2 * static_cast<std::size_t>(quad) + half];
              corners.insert(t.begin(), t.end());
            }
            ASSERT_EQ(corners.size(), 4U);
            for (const std::uint32_t corner : corners) {
              const Voxel offset = cell - surface.cell_of(static_cast<std::int32_t>(corner));
              ASSERT_EQ(offset[axis], 0);
              ASSERT_TRUE(offset.minCoeff() >= 0 && offset.maxCoeff() <= 1);
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(vertices, surface.vertex_count());
  EXPECT_EQ(2 * quads, surface.triangle_count());
}

TEST(SurfaceTest, ABallHasItsVolumeItsRadiusAndNormalsOutwards) {
  constexpr double kRadius = 15.0;
  const BoneModel model = ball_model(40, kRadius);
  const BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  EXPECT_EQ(open_edges(surface.triangles()), 0);
  EXPECT_EQ(branching_edges(surface.triangles()), 0);
  EXPECT_EQ(
      static_cast<long>(surface.vertex_count()) - static_cast<long>(surface.triangle_count()) / 2,
      2)
      << "a sphere by Euler's formula: V - 3/2 F + F = 2";
  const double voxel = std::pow(0.001, 3);
  // Smoothing with variance s² takes s² / R off a radius R, in voxels: here s² = 1.
  const double expected = volume.amount() * voxel * std::pow(1.0 - 1.0 / (kRadius * kRadius), 3);
  const double enclosed = enclosed_volume(surface.vertices(), surface.triangles());
  EXPECT_NEAR(enclosed / expected, 1.0, 0.01);
  const Eigen::Vector3d middle =
      model.grid.origin + Eigen::Vector3d::Constant(0.001 * 0.5 * (40 - 1));
  for (const SurfaceVertex& vertex : surface.vertices()) {
    const Eigen::Vector3d from = place_of(vertex) - middle;
    EXPECT_NEAR(from.norm(), 0.001 * kRadius, 0.0004);
    EXPECT_NEAR(normal_of(vertex).norm(), 1.0, 1e-4);
    EXPECT_GT(normal_of(vertex).dot(from.normalized()), 0.97);
    EXPECT_EQ(vertex.label, 1);
    EXPECT_EQ(vertex.density, 255);
  }
}

TEST(SurfaceTest, FlatFacesAreFlatAndABoxHasItsVolume) {
  const BoneModel model = model_of(30, [](const Voxel& v) {
    return v.x() >= 5 && v.x() < 25 && v.y() >= 5 && v.y() < 20 && v.z() >= 5 && v.z() < 15;
  });
  const BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  EXPECT_EQ(open_edges(surface.triangles()), 0);
  const double enclosed = enclosed_volume(surface.vertices(), surface.triangles());
  EXPECT_NEAR(enclosed / (20 * 15 * 10 * 1e-9), 1.0, 0.07) << "edges are rounded off";
  const auto& flat = surface.vertices()[static_cast<std::size_t>(surface.vertex_of({15, 12, 14}))];
  EXPECT_NEAR(flat.place[2], model.grid.coordinate(2, 14) + 0.0005, 1e-8);
  EXPECT_NEAR(normal_of(flat).z(), 1.0, 1e-4);
}

TEST(SurfaceTest, ThinThingsKeepAThickness) {
  // A sheet of one voxel, a rod of one voxel, a voxel alone.
  for (int axes = 0; axes < 3; ++axes) {
    const BoneModel model = model_of(20, [&](const Voxel& v) {
      return (v.x() == 10) && (axes > 1 || (v.y() > 3 && v.y() < 16) || v.y() == 10) &&
             (axes < 2 ? (axes == 0 ? v.z() > 3 && v.z() < 16 : v.z() == 10)
                       : v.y() == 10 && v.z() == 10);
    });
    BoneVolume volume(model);
    Surface surface;
    surface.update(volume);
    EXPECT_EQ(open_edges(surface.triangles()), 0);
    const double enclosed = enclosed_volume(surface.vertices(), surface.triangles());
    // A sheet is as thick as a voxel; a rod and a voxel alone are rounded off.
    EXPECT_GT(enclosed / (volume.amount() * 1e-9), axes == 0 ? 0.75 : axes == 1 ? 0.4 : 0.2);
    EXPECT_LT(enclosed / (volume.amount() * 1e-9), 1.1);
    for (const SurfaceVertex& vertex : surface.vertices()) {
      const double aside = vertex.place[0] - model.grid.coordinate(0, 10);
      EXPECT_GT(aside * normal_of(vertex).x(), 0.0) << "outwards on either side";
    }
  }
}

TEST(SurfaceTest, BuiltBeforehandItFollowsWhatWasCarvedSinceAndReportsAll) {
  const BoneModel model = rich_model(60, 9);
  BoneVolume volume(model);
  Surface surface(std::make_shared<const StructureDepths>(model, std::vector{false, false, true},
                                                          6.0 * model.grid.spacing));
  EXPECT_FALSE(surface.built());
  double share = 0.0;
  surface.build(volume, [&](double now) {
    EXPECT_GE(now, share);
    share = now;
    return true;
  });
  EXPECT_TRUE(surface.built());
  EXPECT_EQ(share, 1.0);
  RandomStream random(10, "carve");
  carve(volume, random);
  EXPECT_TRUE(surface.update(volume));
  EXPECT_TRUE(surface.rebuilt());
  const std::set<std::int32_t> told(surface.changed_quads().begin(), surface.changed_quads().end());
  EXPECT_EQ(told.size(), surface.triangles().size() / 2);
  EXPECT_EQ(told.size(), surface.changed_quads().size());
  Surface fresh;
  fresh.update(volume);
  EXPECT_EQ(surface.triangle_count(), fresh.triangle_count());
  EXPECT_EQ(open_edges(living(surface.triangles())), 0);
  EXPECT_FALSE(surface.update(volume));
  Surface stopped;
  EXPECT_THROW(stopped.build(volume, [](double) { return false; }), geometry::Cancelled);
}

TEST(SurfaceTest, FollowsWhileAnotherThreadDrills) {
  const BoneModel model = rich_model(40, 5);
  BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  std::atomic<bool> done{false};
  std::thread servo([&] {
    RandomStream random(8, "servo");
    for (int step = 0; step < 25; ++step) {
      carve(volume, random);
    }
    done = true;
  });
  int updates = 0;
  while (!done) {
    surface.update(volume);
    ++updates;
  }
  servo.join();
  surface.update(volume);
  Surface fresh;
  fresh.update(volume);
  EXPECT_TRUE(plain(surface) == plain(fresh)) << updates << " updates meanwhile";
  EXPECT_EQ(open_edges(living(surface.triangles())), 0);
}

TEST(SurfaceTest, SlotsOfWhatIsGoneAreGivenBack) {
  const BoneModel model = ball_model(64, 30.0);
  BoneVolume volume(model);
  Surface surface;
  surface.update(volume);
  const std::size_t before = surface.vertices().size();
  for_each_voxel(volume.grid(), [&](const Voxel& voxel) {
    if (voxel.x() > 8) {
      empty(volume, voxel);
    }
  });
  surface.update(volume);
  EXPECT_TRUE(surface.rebuilt());
  EXPECT_EQ(surface.vertices().size(), surface.vertex_count());
  EXPECT_LT(surface.vertices().size(), before / 4);
  Surface fresh;
  fresh.update(volume);
  EXPECT_TRUE(plain(surface) == plain(fresh));
}

}  // namespace
}  // namespace haptrial::bone
