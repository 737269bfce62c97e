// Nerve monitor of a definition, distances of nerves, and effects of a tool on them.

#include "core/bone/nerve/nerve_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/bone/nerve/nerve_distances.h"
#include "core/bone/nerve/nerve_exposures.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::nerve {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

NerveSetup read(const std::string& text, double rate = 1000.0) {
  Table root = Table::parse(text, "study.toml");
  Table table = root.table("nerve_monitor");
  NerveSetup setup = read_nerve_setup(table, rate);
  root.finish();
  return setup;
}

std::string refusal(const std::string& text, double rate = 1000.0) {
  try {
    read("[nerve_monitor]\n" + text, rate);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const char* const kNerves = R"(
[nerve_monitor]
threshold = 80e-6
muted = true
heard_in = "every other"
[[nerve_monitor.nerves]]
structure = "facial nerve"
channels = ["orbicularis oculi", "orbicularis oris"]
[[nerve_monitor.curves]]
name = "drawn"
points_mm = [[1.0, 2.0, 3.0], [4, 5, 6]]
radius_mm = 0.4
)";

TEST(NerveSetupTest, StructuresAndCurvesAreRead) {
  const NerveSetup s = read(kNerves);
  ASSERT_EQ(s.nerves.size(), 2u);
  EXPECT_EQ(s.nerves[0].name, "facial nerve");
  EXPECT_THAT(s.nerves[0].channels, ElementsAre("orbicularis oculi", "orbicularis oris"));
  EXPECT_THAT(s.nerves[1].channels, ElementsAre("drawn"));
  ASSERT_EQ(s.nerves[1].curve.size(), 2u);
  EXPECT_LT((s.nerves[1].curve[1] - Eigen::Vector3d(4e-3, 5e-3, 6e-3)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(s.nerves[1].radius, 0.4e-3);
  EXPECT_EQ(s.channels(), 3u);
  EXPECT_DOUBLE_EQ(s.monitor.threshold, 80e-6);
  EXPECT_DOUBLE_EQ(s.monitor.highest, 400e-6);
  EXPECT_TRUE(s.muted);
  EXPECT_EQ(s.heard, GivenIn{GivenIn::kEveryOther});
}

TEST(NerveSetupTest, SamplesAreAtLeastEightThousandASecond) {
  for (const double rate : {250.0, 500.0, 1000.0, 1500.0, 2000.0, 3000.0, 4000.0, 10000.0}) {
    const double samples = rate * static_cast<double>(samples_a_tick(rate));
    EXPECT_GE(samples, 8000.0);
    EXPECT_LT(samples, 8000.0 + rate);
  }
  EXPECT_DOUBLE_EQ(read(kNerves, 2000.0).monitor.rate, 8000.0);
}

TEST(NerveSetupTest, EachMistakeGetsASentence) {
  EXPECT_THAT(refusal(""), HasSubstr("nerve_monitor.nerves"));
  const std::string facial = "[[nerve_monitor.nerves]]\nstructure = \"facial nerve\"\n";
  EXPECT_EQ(refusal(facial), "");
  EXPECT_THAT(refusal("threshold = 1e-3\n" + facial),
              AllOf(HasSubstr("nerve_monitor.threshold is 0.001"), HasSubstr("[V]")));
  EXPECT_THAT(refusal("threshold = 300e-6\nhighest_threshold = 200e-6\n" + facial),
              HasSubstr("make it at least as high"));
  EXPECT_THAT(refusal("heard_in = \"some\"\n" + facial), HasSubstr("every other"));
  EXPECT_THAT(refusal("stimulus = 0.01\n" + facial), HasSubstr("nerve_monitor.stimulus"));
  EXPECT_THAT(refusal("treshold = 1e-4\n" + facial), HasSubstr("threshold"));
  EXPECT_THAT(refusal(facial + facial), HasSubstr("two nerves named \"facial nerve\""));
  EXPECT_THAT(refusal(facial + "channels = [\"a\", \"a\"]\n"),
              HasSubstr("two channels named \"a\""));
  EXPECT_THAT(refusal(facial + "channels = []\n"), HasSubstr("channels"));
  EXPECT_THAT(refusal(facial + R"(channels = ["1","2","3","4","5","6","7","8","9"])"),
              HasSubstr("has 9 channels in all; name at most 8"));
  const std::string curve = "[[nerve_monitor.curves]]\nname = \"drawn\"\n";
  EXPECT_THAT(refusal(curve), HasSubstr("points_mm"));
  EXPECT_THAT(refusal(curve + "points_mm = [[1, 2, 3]]\n"), HasSubstr("two points or more"));
  EXPECT_THAT(refusal(curve + "points_mm = [[1, 2], [3, 4]]\n"), HasSubstr("two points or more"));
  EXPECT_THAT(refusal(facial, 200.0), HasSubstr("raise experiment.rate"));
}

/// 40 x 30 x 30 voxels of 0.5 mm, a straight nerve of one voxel along x.
bone::BoneModel block() {
  bone::BoneModel model;
  model.name = "block";
  model.grid = {{40, 30, 30}, {0.0, 0.0, 0.0}, 5e-4};
  model.labels.assign(model.grid.count(), 1);
  for (int i = 0; i < 40; ++i) {
    model.labels[model.grid.index(i, 15, 15)] = 2;
  }
  model.structures = {{}, {"bone", {}, 1.0, false}, {"facial nerve", {}, 0.5, true}};
  return model;
}

std::string no_distances(const std::vector<WatchedNerve>& nerves) {
  try {
    const NerveDistances distances(block(), nerves);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NerveDistancesTest, WhatTheBoneHasNotIsNamed) {
  EXPECT_THAT(no_distances({{"fascial nerve", {}, 5e-4, {"m"}}}),
              AllOf(HasSubstr("nerve_monitor.nerves names \"fascial nerve\", which block does not"),
                    HasSubstr("facial nerve")));
  const std::vector<Eigen::Vector3d> outside{{1e-3, 1e-3, 1e-3}, {1e-3, 20e-3, 1e-3}};
  EXPECT_THAT(no_distances({{"drawn", outside, 5e-4, {"m"}}}),
              AllOf(HasSubstr("point 2 of \"drawn\", (1, 20, 1) mm, lies outside block"),
                    HasSubstr("14.5")));
}

TEST(NerveDistancesTest, AgreeWithGeometry) {
  const std::vector<Eigen::Vector3d> line{
      {2e-3, 5e-3, 5e-3}, {8e-3, 5e-3, 5e-3}, {8e-3, 9e-3, 5e-3}};
  const NerveDistances distances(block(),
                                 {{"facial nerve", {}, 0.0, {"a"}}, {"drawn", line, 1e-3, {"b"}}});
  for (const double y : {7.5e-3, 8.5e-3, 9.3e-3, 11e-3}) {
    for (const double z : {7.5e-3, 5.2e-3}) {
      const auto at = distances.at({10e-3, y, z});
      const double exact = std::hypot(y - 7.5e-3, z - 7.5e-3) - 0.25e-3;
      EXPECT_NEAR(static_cast<double>(at[0]), exact, 0.13e-3) << "a quarter of a voxel";
    }
  }
  EXPECT_NEAR(static_cast<double>(distances.at({5e-3, 5e-3, 8e-3})[1]), 2e-3, 1e-8);
  EXPECT_NEAR(static_cast<double>(distances.at({0.0, 5e-3, 5e-3})[1]), 1e-3, 1e-8);
  EXPECT_NEAR(static_cast<double>(distances.at({11e-3, 13e-3, 5e-3})[1]), 4e-3, 1e-8);
  const double before_the_volume = static_cast<double>(distances.at({10e-3, 7.5e-3, 15e-3})[0]);
  EXPECT_NEAR(before_the_volume, 7.25e-3, 0.13e-3);
  EXPECT_EQ(distances.at({10e-3, 7.5e-3, 200e-3})[0], NerveDistances::kFar);
  EXPECT_EQ(distances.at({std::nan(""), 0.0, 0.0})[0], NerveDistances::kFar);
}

NerveSetup facial() {
  NerveSetup setup;
  setup.nerves = {{"facial nerve", {}, 0.0, {"a"}}};
  return setup;
}

TEST(NerveExposuresTest, TheToolsSurfaceCounts) {
  const NerveSetup setup = facial();
  const auto distances = std::make_shared<const NerveDistances>(block(), setup.nerves);
  NerveExposures exposures(setup, distances, 1, 1e-3);
  ToolAtNerves tool;
  tool.kind = ToolAtNerves::Kind::kBurr;
  tool.tip_B = {10e-3, 10.5e-3, 7.5e-3};
  tool.radius = 1.5e-3;
  tool.power = 1.0;
  tool.force = 2.0;
  const NerveTick tick = exposures.step(tool);
  EXPECT_TRUE(tick.drilling);
  EXPECT_FALSE(tick.suction);
  EXPECT_NEAR(static_cast<double>(tick.nerves[0].distance), 3e-3 - 0.25e-3 - 1.5e-3, 1e-5);
  for (int i = 0; i < 3000; ++i) {
    exposures.step(tool);
  }
  EXPECT_GT(exposures.step(tool).nerves[0].warmth, 1.0f) << "2 N are 2 W under a turning burr";
  tool.kind = ToolAtNerves::Kind::kOther;
  EXPECT_EQ(exposures.step(tool).nerves[0].distance, NerveDistances::kFar);
}

TEST(NerveExposuresTest, TheNearestBallOfALongToolCounts) {
  const NerveSetup setup = facial();
  NerveExposures exposures(setup, std::make_shared<const NerveDistances>(block(), setup.nerves), 1,
                           1e-3);
  ToolAtNerves tool;
  tool.kind = ToolAtNerves::Kind::kBurr;
  tool.tip_B = {10e-3, 13.5e-3, 7.5e-3};
  tool.radius = 1e-3;
  const float far = exposures.step(tool).nerves[0].distance;
  tool.more[0] = {{10e-3, 16.5e-3, 7.5e-3}, 1e-3};
  tool.more[1] = {{10e-3, 10.5e-3, 7.5e-3}, 0.5e-3};
  tool.balls = 2;
  EXPECT_NEAR(static_cast<double>(exposures.step(tool).nerves[0].distance),
              static_cast<double>(far) - 3e-3 + 0.5e-3, 1e-5);
}

TEST(NerveExposuresTest, AProbeGivesPulsesAtItsRate) {
  NerveSetup setup = facial();
  setup.pulses = 4.0;
  setup.current = 1e-3;
  NerveExposures exposures(setup, std::make_shared<const NerveDistances>(block(), setup.nerves), 1,
                           1e-3);
  ToolAtNerves tool;
  tool.kind = ToolAtNerves::Kind::kProbe;
  tool.tip_B = {10e-3, 8.5e-3, 7.5e-3};
  int pulses = 0;
  for (int i = 0; i < 4000; ++i) {
    tool.power = i < 2000 ? 1.0 : 0.0;
    const NerveTick tick = exposures.step(tool);
    pulses += tick.current > 0.0f ? 1 : 0;
    EXPECT_FALSE(tick.drilling || tick.suction);
  }
  EXPECT_EQ(pulses, 8) << "in two seconds of power";
}

TEST(NerveExposuresTest, AStepDoesNotAllocate) {
  const NerveSetup setup = facial();
  NerveExposures exposures(setup, std::make_shared<const NerveDistances>(block(), setup.nerves), 1,
                           1e-3);
  ToolAtNerves tool;
  tool.kind = ToolAtNerves::Kind::kBurr;
  tool.power = 1.0;
  tool.force = 2.0;
  const test::AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) {
    tool.tip_B = {10e-3, 1e-5 * i, 7.5e-3};
    exposures.step(tool);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::nerve
