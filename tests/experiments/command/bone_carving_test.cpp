#include "experiments/command/bone/bone_carving.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::experiments {
namespace {

using bone::Voxel;

TEST(BoneCarvingTest, WhatLiesWithinIsGoneAndTheRestIsThere) {
  const bone::BoneModel model =
      bone::model_of(24, [](const Voxel& v) { return v.x() == 12 ? 2 : 1; });
  const Eigen::Vector3d from = model.grid.centre(4, 5, 6);
  const Eigen::Vector3d to = model.grid.centre(18, 14, 10);
  const Eigen::Vector3d way = to - from;
  for (const bool spare : {false, true}) {
    bone::BoneVolume volume(model);
    carve(volume, Stroke{from, to, 0.0031}, {false, false, spare});
    double gone = 0.0;
    for (int k = 0; k < 24; ++k) {
      for (int j = 0; j < 24; ++j) {
        for (int i = 0; i < 24; ++i) {
          const Eigen::Vector3d centre = model.grid.centre(i, j, k);
          const double s = std::clamp((centre - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
          const double least = (centre - from - s * way).norm();
          const double half = 0.0005;  // of a voxel
          const float left = volume.density(Voxel(i, j, k));
          const bool stays = least > 0.0031 + half || (spare && i == 12);
          ASSERT_TRUE(!stays || left == 1.0F);
          ASSERT_TRUE(stays || least > 0.0031 - half + 1e-6 || left == 0.0F);
          gone += 1.0 - left;
        }
      }
    }
    const double r = 3.1, length = std::hypot(14, 9, 4);
    const double capsule =
        std::numbers::pi * r * r * length + 4.0 / 3.0 * std::numbers::pi * r * r * r;
    if (!spare) {
      EXPECT_NEAR(gone, capsule, 0.015 * capsule);
    }
  }
}

TEST(BoneCarvingTest, APlaneTakesASlab) {
  const bone::BoneModel model = bone::model_of(24, [](const Voxel&) { return 1; });
  bone::BoneVolume volume(model);
  carve(volume, PlaneCut{model.grid.centre(0, 10, 0), Eigen::Vector3d::UnitY(), 0.0016}, {});
  for (int j = 0; j < 24; ++j) {
    const float left = j >= 9 && j <= 11 ? 0.0F : (j == 8 || j == 12 ? 0.9F : 1.0F);  // 3.2 wide
    EXPECT_NEAR(volume.density(Voxel(3, j, 20)), left, 1e-6) << j;
  }
}

TEST(BoneCarvingTest, TextsAreReadInMillimetres) {
  const Stroke ball = parse_stroke("--drill", "1,-2.5,3e1,4");
  EXPECT_EQ(ball.from, ball.to);
  EXPECT_TRUE(ball.from.isApprox(Eigen::Vector3d(0.001, -0.0025, 0.03)));
  EXPECT_DOUBLE_EQ(ball.radius, 0.002);
  EXPECT_TRUE(
      parse_stroke("--drill", "0,0,0,1,2,3,4").to.isApprox(Eigen::Vector3d(0.001, 0.002, 0.003)));
  const PlaneCut cut = parse_plane_cut("--cut", "1,2,3,0,0,-5,2");
  EXPECT_TRUE(cut.normal.isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_DOUBLE_EQ(cut.half_width, 0.001);
}

TEST(BoneCarvingTest, OtherTextsGetASentence) {
  for (const char* text : {"", "1,2,3", "1,2,3,0", "1,2,3,-4", "1,2,3,4,", "a,2,3,4", "1,2,3,nan",
                           "1,2,3,4,5,6", "1, 2,3,4", "1,2,3,inf"}) {
    try {
      parse_stroke("--drill", text);
      ADD_FAILURE() << "'" << text << "' was taken";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("allowed:"));
    }
  }
  EXPECT_THROW(parse_plane_cut("--cut", "1,2,3,0,0,0,2"), InputError);
  EXPECT_THROW(parse_plane_cut("--cut", "1,2,3,0,0,1,0"), InputError);
}

}  // namespace
}  // namespace haptrial::experiments
