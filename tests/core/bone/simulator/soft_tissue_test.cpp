#include "core/bone/simulator/soft_tissue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/bone/drill/drill.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::bone::soft_tissue_test {
namespace {

using Eigen::Vector3d;

constexpr double kEdge = 0.5e-3;  // of a voxel [m]
constexpr double kTop = 5e-3;     // of the layer: half a voxel above the centre of its last one [m]
constexpr double kRadius = 3e-3;
const Vector3d kMiddle(15e-3, 15e-3, 0.0);

/// A layer of dura of z < kTop, at least `from` voxels thick, with nothing or bone over it.
BoneModel layer(int from = 0, std::uint8_t over = 0) {
  BoneModel model;
  model.name = "layer";
  model.grid = {{61, 61, 24}, {0.0, 0.0, 0.5 * kEdge}, kEdge};
  model.structures = {{}, {"bone", {}}, {"sigmoid sinus and dura", {}, 0.25, true}};
  for (int k = 0; k < 24; ++k) {
    const std::uint8_t label = k >= 10 ? over : k >= from ? 2 : 0;
    model.labels.insert(model.labels.end(), 61 * 61, label);
  }
  return model;
}

SoftTissueParameters dura(double tears_at, double suction = 0.2) {
  return {"dura", 400.0, tears_at, suction};
}

/// Pressed down by `depth` in its middle, from above.
Vector3d press_to(SoftTissue& soft, double depth, double radius = kRadius, bool sucks = false) {
  Vector3d force;
  constexpr int kSteps = 400;
  for (int i = -20; i <= kSteps; ++i) {
    force = soft.tick(kMiddle + Vector3d(0, 0, kTop + radius - depth * i / kSteps), radius, sucks);
  }
  return force;
}

TEST(SoftTissueTest, AFlatLayerIsASpringOfItsStiffness) {
  const SoftTissueParameters one[] = {dura(3.0)};
  SoftTissue soft(layer(), one, kRadius);
  for (const double depth : {0.5e-3, 1e-3, 2e-3}) {
    const Vector3d force = press_to(soft, depth);
    // A corner half a voxel wide is smoothed away at the surface, 1 / 8 of a voxel.
    EXPECT_NEAR(force.z(), 400.0 * depth, 400.0 * 0.15 * kEdge) << depth;
    EXPECT_LT(force.head<2>().norm(), 1e-9);
    EXPECT_TRUE(soft.tears().empty());
  }
}

/// The surface that is drawn touches the ball in one place and is outside of it elsewhere.
TEST(SoftTissueTest, ItsDentLiesOnTheBall) {
  const SoftTissueParameters one[] = {dura(3.0)};
  SoftTissue soft(layer(), one, kRadius);
  EXPECT_EQ(soft.dent(), Dent());
  for (const double depth : {0.5e-3, 1e-3, 2e-3}) {
    press_to(soft, depth);
    const Dent dent = soft.dent();
    EXPECT_EQ(dent.label, 2);
    EXPECT_NEAR(dent.depth, depth, 0.15 * kEdge);
    EXPECT_NEAR(dent.out.z(), 1.0, 1e-9);
    const Vector3d centre = dent.place + (dent.radius - dent.depth) * dent.out;
    EXPECT_NEAR((centre - kMiddle - Vector3d(0, 0, kTop + kRadius - depth)).norm(), 0.0, 1e-9);
    for (int i = 0; i <= 100; ++i) {
      const double aside = 0.01 * i * dent.width();
      const double left = 1.0 - aside * aside / (dent.width() * dent.width());
      const Vector3d at = dent.place + Vector3d(aside, 0, -dent.depth * left * left);
      EXPECT_GE((at - centre).norm(), dent.radius * (1.0 - 1e-9)) << i;
      EXPECT_TRUE(dent.bounds().contains(at));
    }
  }
  soft.tick(kMiddle + Vector3d(0, 0, kTop + kRadius + 1e-3), kRadius, false);
  EXPECT_EQ(soft.dent(), Dent());
  EXPECT_TRUE(soft.dent().bounds().isEmpty());
}

TEST(SoftTissueTest, ItTearsAtItsForceAndIsNotFeltInTheHole) {
  const SoftTissueParameters one[] = {dura(1.0)};
  SoftTissue soft(layer(), one, kRadius);
  Vector3d at = kMiddle + Vector3d(0, 0, kTop + kRadius);
  soft.tick(at + Vector3d(0, 0, 1e-4), kRadius, false);
  double most = 0.0;
  int tears = 0;
  Tear tear;
  for (int i = 0; i < 400; ++i) {
    at.z() -= 1e-5;
    const double force = soft.tick(at, kRadius, false).norm();
    EXPECT_TRUE(tears == 0 || force == 0.0);
    most = std::max(most, force);
    for (const Tear& each : soft.tears()) {
      tear = each;
      ++tears;
    }
  }
  ASSERT_EQ(tears, 1);
  EXPECT_EQ(tear.label, 2);
  EXPECT_FALSE(tear.by_suction);
  EXPECT_GE(tear.force, 1.0);
  EXPECT_LT(tear.force, 1.0 + 400.0 * 1e-5 + 1e-9);
  EXPECT_EQ(tear.force, most);
  EXPECT_NEAR(tear.depth, 2.5e-3, 0.1e-3);
  EXPECT_NEAR((tear.place_B - kMiddle - Vector3d(0, 0, kTop)).norm(), 0.0, 0.2 * kEdge);
  // Out and back into the hole: nothing; beside it: a spring.
  at.z() = kTop + kRadius + 1e-3;
  soft.tick(at, kRadius, false);
  EXPECT_EQ(press_to(soft, 1e-3).norm(), 0.0);
  EXPECT_TRUE(soft.in_hole());
  soft.tick(at, kRadius, false);
  EXPECT_FALSE(soft.in_hole());
  at.x() -= 2.2 * kRadius;
  soft.tick(at, kRadius, false);
  at.z() = kTop + kRadius - 1e-3;
  EXPECT_NEAR(soft.tick(at, kRadius, false).z(), 0.4, 0.05);
}

/// A sheet of half a millimetre gives a small burr no way out once it is through.
TEST(SoftTissueTest, WhatGoesThroughAThinSheetTearsIt) {
  const SoftTissueParameters one[] = {dura(50.0)};
  SoftTissue soft(layer(9), one, 0.5e-3);
  int tears = 0;
  soft.tick(kMiddle + Vector3d(0, 0, kTop + 2e-3), 0.5e-3, false);
  for (int i = 0; i < 300; ++i) {
    soft.tick(kMiddle + Vector3d(0, 0, kTop + 1e-3 - 1e-5 * i), 0.5e-3, false);
    tears += static_cast<int>(soft.tears().size());
  }
  EXPECT_EQ(tears, 1);
}

TEST(SoftTissueTest, ATubeThatSucksHoldsItUntilItComesOff) {
  const SoftTissueParameters one[] = {dura(3.0, 0.2)};
  SoftTissue soft(layer(), one, 1.2e-3);
  EXPECT_GT(press_to(soft, 0.3e-3, 1.2e-3, true).z(), 0.0);
  double strongest = 0.0;
  double off = 0.0;
  for (int i = 0; i < 150; ++i) {
    const double gap = -0.3e-3 + 1e-5 * i;
    const double pull = soft.tick(kMiddle + Vector3d(0, 0, kTop + 1.2e-3 + gap), 1.2e-3, true).z();
    strongest = std::min(strongest, pull);
    off = pull < 0.0 ? gap : off;
    EXPECT_TRUE(soft.tears().empty());
  }
  EXPECT_NEAR(strongest, -0.2, 400.0 * 1e-5);
  EXPECT_NEAR(off, 0.5e-3, 0.1e-3);
  // Without suction nothing pulls.
  press_to(soft, 0.3e-3, 1.2e-3, false);
  EXPECT_EQ(soft.tick(kMiddle + Vector3d(0, 0, kTop + 1.3e-3), 1.2e-3, false).norm(), 0.0);
}

TEST(SoftTissueTest, SuctionThatHoldsMoreThanItBearsTearsIt) {
  const SoftTissueParameters one[] = {dura(0.3, 0.6)};
  SoftTissue soft(layer(), one, 1.2e-3);
  press_to(soft, 0.2e-3, 1.2e-3, true);
  for (int i = 0; i < 200 && soft.tears().empty(); ++i) {
    soft.tick(kMiddle + Vector3d(0, 0, kTop + 1e-3 + 1e-5 * i), 1.2e-3, true);
  }
  ASSERT_EQ(soft.tears().size(), 1u);
  EXPECT_TRUE(soft.tears()[0].by_suction);
  EXPECT_NEAR(soft.tears()[0].force, 0.3, 400.0 * 1e-5);
}

/// A heap of voxels, pressed along closed paths: the work is zero but for the path's steps.
TEST(SoftTissueTest, AClosedPathGivesNoEnergy) {
  BoneModel model = layer();
  RandomStream random(5, "bumps");
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    const std::size_t k = at / (61 * 61);
    model.labels[at] = k == 10 && random.uniform() < 0.4 ? 2 : model.labels[at];
  }
  const SoftTissueParameters one[] = {dura(50.0)};
  SoftTissue soft(model, one, kRadius);
  soft.tick(kMiddle + Vector3d(0, 0, 0.03), kRadius, false);
  constexpr int kSteps = 20000;
  const auto place = [&](int i) {
    const double a = 2.0 * std::numbers::pi * i / kSteps;
    return Vector3d(kMiddle + Vector3d(3e-3 * std::sin(a), 2e-3 * std::sin(2.0 * a),
                                       kTop + kRadius - 1e-3 - 1.2e-3 * std::sin(3.0 * a)));
  };
  double work = 0.0, moved = 0.0;
  Vector3d before = soft.tick(place(0), kRadius, false);
  for (int i = 1; i <= kSteps; ++i) {
    const Vector3d force = soft.tick(place(i), kRadius, false);
    const double step = 0.5 * (force + before).dot(place(i) - place(i - 1));
    work += step;
    moved += std::abs(step);
    before = force;
  }
  EXPECT_GT(moved, 1e-3);
  EXPECT_LT(std::abs(work), 2e-4 * moved);
}

/// A second difference of a distance along an axis is at most two voxels, so that the gradient
/// turns by at most 2 / voxel along each of three axes.
TEST(SoftTissueTest, TheGradientOfASurfaceHasNoSteps) {
  BoneModel model = layer();
  RandomStream random(7, "bumps");
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    const std::size_t k = at / (61 * 61);
    model.labels[at] = k >= 10 && k < 14 && random.uniform() < 0.2 ? 2 : model.labels[at];
  }
  const SurfaceDepth depth(model, 2, kRadius);
  constexpr double kStep = 1e-6;
  const Vector3d along = Vector3d(1.0, 0.7, 0.03).normalized();
  SurfaceDepth::LocalTissue before{};
  ASSERT_TRUE(depth.at(Vector3d(8e-3, 8e-3, kTop + 1e-3), before));
  for (int i = 1; i < 12000; ++i) {
    SurfaceDepth::LocalTissue here{};
    ASSERT_TRUE(depth.at(Vector3d(8e-3, 8e-3, kTop + 1e-3) + i * kStep * along, here));
    ASSERT_LT((here.gradient - before.gradient).norm(), 6.0 / kEdge * kStep) << i;
    ASSERT_NEAR(here.distance - before.distance,
                0.5 * kStep * along.dot(here.gradient + before.gradient),
                6.0 / kEdge * kStep * kStep);
    before = here;
  }
}

/// Volumes are cropped, and tools come from outside of them.
TEST(SoftTissueTest, AStructureEndsWhereTheVolumeDoes) {
  BoneModel model = layer();
  model.grid.size[2] = 10;  // nothing is over it
  model.labels.resize(61 * 61 * 10);
  const SurfaceDepth depth(model, 2, kRadius);
  for (const double height : {0.5e-3, 1e-3, 2e-3, 3e-3}) {
    SurfaceDepth::LocalTissue here{};
    ASSERT_TRUE(depth.at(kMiddle + Vector3d(0.0, 0.0, kTop + height), here)) << height;
    EXPECT_NEAR(here.distance, height, 0.15 * kEdge);
    EXPECT_NEAR(here.gradient.z(), 1.0, 1e-3);
  }
  const SoftTissueParameters one[] = {dura(3.0)};
  SoftTissue soft(model, one, kRadius);
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i <= 400; ++i) {
    const double height = 20e-3 - 18e-3 * i / 400;
    const Vector3d force = soft.tick(kMiddle + Vector3d(0, 0, kTop + height), kRadius, false);
    ASSERT_LT((force - before).norm(), 1.1 * 400.0 * 18e-3 / 400) << height;
    before = force;
  }
  EXPECT_GT(before.z(), 0.3);
}

TEST(SoftTissueTest, AToolThatIsTakenInHandInItIsNotFeltBeforeItHasLeft) {
  const SoftTissueParameters one[] = {dura(3.0)};
  SoftTissue soft(layer(), one, kRadius);
  EXPECT_GT(press_to(soft, 1e-3).norm(), 0.3);
  soft.forget();
  const Vector3d in = kMiddle + Vector3d(0, 0, kTop + kRadius - 1e-3);
  EXPECT_EQ(soft.tick(in, kRadius, false).norm(), 0.0);
  EXPECT_TRUE(soft.tears().empty());
  soft.tick(in + Vector3d(0, 0, 2e-3), kRadius, false);
  EXPECT_GT(soft.tick(in, kRadius, false).norm(), 0.3);
}

/// A burr feels and removes what it would if the soft voxels were not there, to the bit.
TEST(SoftTissueTest, ABurrDrillsTheBoneBesideItAlone) {
  const BoneModel both = layer(0, 1);
  BoneModel bone_alone = both;
  for (std::uint8_t& label : bone_alone.labels) {
    label = label == 2 ? 0 : label;
  }
  const BurrParameters burr = default_burr(BurrKind::kCutting, 2.0 * kRadius);
  std::array<bool, 256> soft{};
  soft[2] = true;
  Drill drill(burr, both.structures, best_instruction_set(), soft);
  Drill other(burr, both.structures);
  BoneVolume first(both), second(bone_alone);
  RandomStream random(3, "tip");
  for (int i = 0; i < 200; ++i) {
    const Vector3d tip(0.015 + 2e-3 * random.uniform(), 0.015 + 2e-3 * random.uniform(),
                       kTop + 5e-3 * random.uniform() - 3e-3);
    const auto turn = Eigen::Quaterniond(1.0, random.uniform(), random.uniform(), 0.0).normalized();
    drill.begin_tick();
    other.begin_tick();
    const Contact a = drill.touch(first, tip, turn);
    const Contact b = other.touch(second, tip, turn);
    ASSERT_EQ(a.samples, b.samples);
    ASSERT_EQ(a.volume, b.volume);
    ASSERT_EQ(a.push, b.push);
    ASSERT_EQ(a.turn, b.turn);
    ASSERT_EQ(a.centroid, b.centroid);
    ASSERT_EQ(drill.remove(first, a, 3.0, 1.0, 0.02).amount,
              other.remove(second, b, 3.0, 1.0, 0.02).amount);
  }
  EXPECT_EQ(first.density(Voxel(30, 30, 9)), 1.0F) << "dura";
  EXPECT_LT(second.amount(), BoneVolume(bone_alone).amount() - 50.0);
}

TEST(SoftTissueTest, ATickDoesNotAllocate) {
  const SoftTissueParameters one[] = {dura(0.5)};
  SoftTissue soft(layer(), one, kRadius);
  const haptrial::test::AllocationGuard guard;
  int tears = 0;
  for (int i = 0; i < 4000; ++i) {
    const double a = 2e-2 * i;
    soft.tick(kMiddle + Vector3d(8e-3 * std::sin(0.11 * a), 8e-3 * std::cos(0.13 * a),
                                 kTop + kRadius - 2e-3 * std::sin(a)),
              kRadius, i % 400 < 200);
    tears += static_cast<int>(soft.tears().size());
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(tears, 3);
}

TEST(SoftTissueTest, StructuresThatAreNotThereAreRefused) {
  const SoftTissueParameters carotid[] = {{"carotid", 400.0, 1.0, 0.2}};
  EXPECT_EQ(haptrial::test::message_of([&] { check_soft_tissue(layer(), carotid); }),
            "soft_tissue: the bone layer has no structure 'carotid'; it has sigmoid sinus and "
            "dura");
  BoneModel named = layer();
  named.structures.push_back({"tooth"});
  const SoftTissueParameters tooth[] = {{"tooth", 400.0, 1.0, 0.2}};
  EXPECT_EQ(haptrial::test::message_of([&] { check_soft_tissue(named, tooth); }),
            "soft_tissue: the bone layer has no structure 'tooth'; it has sigmoid sinus and dura");
  const SoftTissueParameters twice[] = {dura(1.0), {"sigmoid sinus", 400.0, 1.0, 0.2}};
  EXPECT_EQ(haptrial::test::message_of([&] { check_soft_tissue(layer(), twice); }),
            "soft_tissue: 'sigmoid sinus and dura' is named twice");
}

}  // namespace
}  // namespace haptrial::bone::soft_tissue_test
