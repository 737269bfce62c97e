#include "core/bone/simulator/cut_plane.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "tests/core/bone/model/pieces_support.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::bone::cut_plane_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::for_each_voxel;
using test::make_box;

/// The whole cut; returns how many ticks it took.
int cut(BoneWorld& world, const CutPlane& plane, CutPlaneTool& tool, int most = 2000) {
  tool.begin(world, plane);
  int ticks = 0;
  while (tool.busy()) {
    tool.step(world, most);
    ++ticks;
  }
  return ticks;
}

/// Pose with z, the direction of the cut, along `normal`.
Isometry3d looking(const Vector3d& normal, const Vector3d& at, double turn = 0.0) {
  Isometry3d pose(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal.normalized()) *
                  Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
  pose.translation() = at;
  return pose;
}

constexpr double kEdge = 0.5e-3;  // of a voxel of make_box [m]

TEST(CutPlaneTest, ACutThroughABoxLeavesTwoPiecesOfExactSizes) {
  BoneWorld world(make_box({40, 20, 18}));
  const Vector3d middle = world.volume(0).grid().centre(25, 10, 9);
  // The cut reaches from within layer 24 to within layer 26.
  const Vector3d from = middle - Vector3d(kEdge, 0, 0);
  CutPlaneTool tool;
  cut(world, {looking(Vector3d::UnitX(), from), 0.02, 0.02, 2 * kEdge}, tool);
  EXPECT_FALSE(tool.busy());
  EXPECT_EQ(tool.removed().voxels, 3 * 20 * 18);
  EXPECT_EQ(tool.removed().amount, 3.0 * 20 * 18);
  const auto events = test::settle(world);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(test::voxels_in(world.volume(0)), 24 * 20 * 18);
  EXPECT_EQ(test::voxels_in(world.volume(1)), 13 * 20 * 18);
}

TEST(CutPlaneTest, WhatIsRemovedIsInTheBoxAndAllOfItsCentresAre) {
  RandomStream random(1, "cuts");
  std::int64_t inside = 0;
  for (int trial = 0; trial < 40; ++trial) {
    RandomStream densities(2, "densities");
    BoneWorld world(test::make_bone(
        {30, 28, 26}, [](const Voxel&) { return true; }, &densities));
    const geometry::VoxelGrid& grid = world.volume(0).grid();
    const CutPlane plane{
        looking({random.normal(), random.normal(), random.normal()},
                grid.centre(15, 14, 13) + 4e-3 * Vector3d(random.normal(), random.normal(), 0.0),
                random.uniform(0.0, 6.0)),
        random.uniform(0.5e-3, 12e-3), random.uniform(0.5e-3, 12e-3), random.uniform(0.0, 6e-3)};
    const double before = world.volume(0).amount();
    CutPlaneTool tool;
    cut(world, plane, tool);
    EXPECT_NEAR(before - world.volume(0).amount(), tool.removed().amount, 1e-9);
    std::int64_t gone = 0;
    for_each_voxel(grid, [&](const Voxel& v) {
      const Vector3d p_C = plane.pose_WC.inverse() * grid.centre(v);
      const Vector3d beyond(std::abs(p_C.x()) - 0.5 * plane.width,
                            std::abs(p_C.y()) - 0.5 * plane.height,
                            std::max(-p_C.z(), p_C.z() - plane.depth));
      const bool removed = world.volume(0).density(v) == 0.0F;
      gone += removed ? 1 : 0;
      if (beyond.maxCoeff() <= 0.0) {
        EXPECT_TRUE(removed) << "trial " << trial << " at " << v.transpose();
        ++inside;
      }
      // A ray in a voxel passes its centre within half of its diagonal.
      if (beyond.cwiseMax(0.0).norm() > 0.5 * std::sqrt(3.0) * kEdge + 1e-9) {
        EXPECT_FALSE(removed) << "trial " << trial << " at " << v.transpose();
      }
    });
    EXPECT_EQ(gone, tool.removed().voxels);
    std::int64_t labels = 0;
    for (const std::uint32_t count : tool.removed().by_label) {
      labels += count;
    }
    EXPECT_EQ(labels, gone);
  }
  EXPECT_GT(inside, 20'000);
}

TEST(CutPlaneTest, NoBridgeStaysWhateverTheAngleEvenWithoutDepth) {
  RandomStream random(3, "cuts");
  for (int trial = 0; trial < 150; ++trial) {
    BoneWorld world(make_box({24, 22, 20}), Isometry3d::Identity(), {.smallest_piece = 1});
    const geometry::VoxelGrid& grid = world.volume(0).grid();
    Vector3d normal(random.normal(), random.normal(), random.normal());
    if (trial % 5 == 0) {
      normal = Vector3d(1.0, trial % 2, trial % 3 - 1.0);  // along voxels and their diagonals
    }
    normal.normalize();
    const Vector3d through =
        grid.centre(12, 11, 10) +
        kEdge * Vector3d(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4));
    CutPlaneTool tool;
    cut(world, {looking(normal, through, random.uniform(0, 6)), 0.04, 0.04, 0.0}, tool);
    for_each_voxel(grid, [&](const Voxel& v) {
      const auto side = [&](const Voxel& u) { return normal.dot(grid.centre(u) - through); };
      for (int axis = 0; axis < 3; ++axis) {
        const Voxel u = v + Voxel::Unit(axis);
        const bool bridge = world.volume(0).density(v) > 0.0F &&
                            world.volume(0).density(u) > 0.0F && side(u) * side(v) < 0.0;
        ASSERT_FALSE(bridge) << "trial " << trial << " at " << v.transpose();
      }
    });
    // Both halves are whole: convex but for the cut, so crumbs only lie at it.
    std::vector<std::size_t> sizes;
    for (const auto& part : test::walk_parts(
             grid, [&](const Voxel& v) { return world.volume(0).density(v) > 0.0F; })) {
      sizes.push_back(part.size());
    }
    std::sort(sizes.rbegin(), sizes.rend());
    ASSERT_GE(sizes.size(), 2U) << "trial " << trial;
    EXPECT_GT(sizes[1], 300U);
    if (sizes.size() > 2) {
      EXPECT_LT(sizes[2], 10U);
    }
  }
}

TEST(CutPlaneTest, BesideBoneAndWithoutAPlaneNothingHappens) {
  BoneWorld world(make_box({20, 20, 18}));
  const Vector3d middle = world.volume(0).grid().centre(10, 10, 9);
  CutPlaneTool tool;
  const auto nothing = [&](const CutPlane& plane) {
    cut(world, plane, tool);
    return tool.removed().voxels == 0;
  };
  EXPECT_TRUE(nothing({looking(Vector3d::UnitX(), middle + Vector3d(0.2, 0, 0)), 0.02, 0.02, 0.1}));
  EXPECT_TRUE(nothing({looking(Vector3d::UnitX(), middle), std::nan(""), 0.02, 0.1}));
  EXPECT_TRUE(nothing({looking(Vector3d::UnitX(), middle), 0.0, 0.02, 0.1}));
  EXPECT_TRUE(nothing({looking(Vector3d::UnitX(), middle), 0.02, 1e9, 0.1}));
  EXPECT_TRUE(nothing({looking(Vector3d::UnitX(), middle), 0.02, 0.02, -0.1}));
  EXPECT_EQ(world.volume(0).amount(), 20.0 * 20 * 18);
}

TEST(CutPlaneTest, ItsSidesAreReadFromADefinition) {
  Table good = Table::parse("width = 0.02\nheight = 0.03\ndepth = 0.0\n", "c.toml");
  const CutPlane plane = cut_plane_schema().read(good);
  good.finish();
  EXPECT_EQ(plane.width, 0.02);
  EXPECT_EQ(plane.height, 0.03);
  EXPECT_EQ(plane.depth, 0.0);
  Table bad = Table::parse("width = 0.0\nheight = 0.03\ndepth = 0.0\n", "c.toml");
  cut_plane_schema().read(bad);
  EXPECT_THROW(bad.finish(), InputError);
}

TEST(CutPlaneTest, TheCutIsTheSameHoweverItIsSpreadAndThoughPiecesMoveAndSplitMeanwhile) {
  const BoneModel box = make_box({40, 20, 18});
  const CutPlane plane{looking({1.0, 0.4, 0.2}, box.grid.centre(20, 9, 8)), 0.03, 0.03, 1e-3};
  BoneWorld at_once(box);
  CutPlaneTool tool;
  EXPECT_GT(cut(at_once, plane, tool, 1'000'000'000), 0);
  const auto removed = tool.removed();

  BoneWorld spread(box, Isometry3d::Identity(), {.smallest_piece = 1, .moves_per_tick = 7});
  spread.grab({0, Voxel(1, 1, 1), 0.0}, Isometry3d::Identity());
  CutPlaneTool slow;
  slow.begin(spread, plane);
  int ticks = 0;
  std::size_t allocations = 0;
  for (; slow.busy(); ++ticks) {
    if (ticks == 20) {  // something else cuts a corner off
      for_each_voxel(box.grid, [&](const Voxel& v) {
        if (v.sum() == 12) {
          spread.volume(0).take(spread.volume(0).address(v), 1.0F);
        }
      });
    }
    spread.search();
    haptrial::test::AllocationGuard guard;
    spread.step();
    slow.step(spread, 300);
    Isometry3d away = Isometry3d::Identity();
    away.translation().x() = 1e-4 * ticks;
    spread.drag(away);
    allocations += guard.count();
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_GT(ticks, 20);
  EXPECT_GT(spread.pieces(), 1);
  std::int64_t corner = 0;
  for_each_voxel(box.grid, [&](const Voxel& v) {
    const bool expected = at_once.volume(0).density(v) > 0.0F && v.sum() != 12;
    ASSERT_EQ(spread.holder(v) >= 0, expected) << v.transpose();
    corner += v.sum() == 12 && at_once.volume(0).density(v) == 0.0F ? 1 : 0;
  });
  EXPECT_EQ(corner, 0);  // so the counts are the same
  EXPECT_EQ(slow.removed().voxels, removed.voxels);
}

/// The cut goes in slices, and is thick enough that a single ray empties more than a step may.
TEST(CutPlaneTest, EachVoxelIsToldOnceWithItsPieceAndLabelAndNoStepEmptiesTooMany) {
  BoneModel box = test::make_bone({30, 26, 700}, [](const Voxel& v) { return v.x() % 7 != 0; });
  for (std::size_t i = 0; i < box.labels.size(); ++i) {
    box.labels[i] = box.labels[i] == 0 ? 0 : i % 3 == 0 ? 2 : 1;
  }
  box.structures.resize(3);
  BoneWorld world(box, Isometry3d::Identity(), {.split_initial = true});
  test::settle(world);
  ASSERT_GT(world.pieces(), 3);
  const auto place = box.grid.centre(15, 13, 0);
  CutPlaneTool tool;
  tool.begin(world, {looking(Vector3d::UnitZ(), place, 0.3), 0.012, 0.008, 0.3});
  std::map<std::size_t, std::pair<int, int>> told;  // piece and label, by index
  std::vector<int> holders(box.grid.count());
  for_each_voxel(box.grid, [&](const Voxel& v) { holders[box.grid.index(v)] = world.holder(v); });
  std::size_t most = 0;
  while (tool.busy()) {
    const std::int64_t before = tool.removed().voxels;
    tool.step(world, 4000);
    EXPECT_EQ(tool.removed().voxels - before, static_cast<std::int64_t>(tool.emptied().size()));
    most = std::max(most, tool.emptied().size());
    for (const EmptiedIn& gone : tool.emptied()) {
      EXPECT_TRUE(gone.by_cut);
      const std::size_t index = box.grid.index(gone.voxel);
      EXPECT_TRUE(told.insert({index, {gone.piece, gone.label}}).second) << "told twice";
    }
  }
  EXPECT_EQ(most, CutPlaneTool::kMostEmptied) << "or the limit is not tried";
  EXPECT_EQ(static_cast<std::int64_t>(told.size()), tool.removed().voxels);
  for_each_voxel(box.grid, [&](const Voxel& v) {
    const std::size_t index = box.grid.index(v);
    const auto row = told.find(index);
    const bool gone = holders[index] >= 0 && world.holder(v) < 0;
    ASSERT_EQ(gone, row != told.end()) << v.transpose();
    if (gone) {
      ASSERT_EQ(row->second, std::pair(holders[index], int{box.labels[index]}));
    }
  });
}

}  // namespace
}  // namespace haptrial::bone::cut_plane_test
