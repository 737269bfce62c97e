#include "protocols/bone_drilling/replay_difference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/protocols/drilling_fixture.h"

namespace haptrial::protocols {
namespace {

using testing::HasSubstr;

record::RemovalRow row_of(const bone::EmptiedIn& gone) {
  record::RemovalRow row{};
  row.piece = gone.piece;
  row.voxel = {gone.voxel.x(), gone.voxel.y(), gone.voxel.z()};
  row.label = gone.label;
  return row;
}

bone::EmptiedIn gone(int i, int piece = 0) { return {piece, {i, 8, 9}, 1, false}; }

TEST(ReplayDifferenceTest, TheOrderOfVoxelsWithinATickIsNoDifference) {
  const std::vector<bone::EmptiedIn> emptied{gone(15), gone(14), gone(16)};
  std::vector<record::RemovalRow> rows{row_of(gone(16)), row_of(gone(14)), row_of(gone(15))};
  EXPECT_EQ(difference(7, rows, emptied), "");
  rows.back() = row_of(gone(17));
  EXPECT_EQ(difference(7, rows, emptied),
            "on tick 7 the record has (16, 8, 9) of piece 0 with label 1 emptied, and the "
            "simulation (15, 8, 9) of piece 0 with label 1");
}

TEST(ReplayDifferenceTest, AVoxelMoreOrOfAnotherPieceIsOne) {
  const std::vector<bone::EmptiedIn> emptied{gone(15)};
  const std::vector<record::RemovalRow> none;
  const std::vector<record::RemovalRow> two{row_of(gone(15)), row_of(gone(16))};
  const std::vector<record::RemovalRow> other{row_of(gone(15, 1))};
  EXPECT_THAT(difference(7, none, emptied), HasSubstr("no further voxel"));
  EXPECT_THAT(difference(7, two, emptied), HasSubstr("and the simulation none"));
  EXPECT_THAT(difference(7, other, emptied), HasSubstr("of piece 1"));
}

/// One burr takes bone on both sides of a gap while one side is on its way to a piece of its own.
TEST(ReplayDifferenceTest, ASlowSearchGivesTheSameBoneInAnotherOrder) {
  const bone::BoneModel model = test::dumbbell();
  const bone::SimulatorParameters parameters = test::workshop(model);
  bone::Simulator live(model, parameters);
  bone::Simulator again(model, parameters);
  const DrillingInput input(test::by_buttons());
  int reordered = 0;
  constexpr std::uint64_t kTicks = 12000;
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    // Straight down between the blocks: both lose the same voxels on the same ticks.
    const double y = 0.005 - 0.008 * static_cast<double>(tick) / kTicks;
    const bone::SimulatorInput now = input.of(as_recorded(test::at({0.0, y, 0.0}, 1u)), 1e-3);
    if (tick == 0) {
      live.begin(now.functions);
      again.begin(now.functions);
    }
    if (live.world().is_born(live.world().pieces() - 1)) {  // afterwards its thread has no time
      live.world().search();
    }
    live.tick(now);
    again.tick(now);
    std::vector<record::RemovalRow> rows;
    for (const bone::EmptiedIn& each : live.emptied()) {
      rows.push_back(row_of(each));
    }
    ASSERT_EQ(difference(tick, rows, again.emptied()), "");
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const bone::Voxel& voxel = again.emptied()[n].voxel;
      reordered += rows[n].voxel[0] != voxel.x() || rows[n].voxel[1] != voxel.y() ? 1 : 0;
    }
  }
  EXPECT_EQ(live.world().pieces(), 2) << "a part is on its way";
  EXPECT_GT(reordered, 0);
}

/// A plate on a block of 16 mm, a screw in its first hole, the plate off again.
TEST(ReplayDifferenceTest, ScrewsOfAPlateThatCameOffHoldNothing) {
  bone::BoneModel block;
  block.grid = {{32, 32, 32}, {0.0, 0.0, 0.0}, 5e-4};
  block.labels.assign(block.grid.count(), 1);
  block.structures = {{}, {"bone", {}, 1.0, false}};
  bone::SimulatorParameters parameters = test::workshop(block);
  bone::ToolSpec plate, driver;
  plate.kind.emplace<bone::PlateTool>().holes = 2;
  driver.kind = bone::ScrewTool{};
  parameters.tools = {plate, driver};
  bone::Simulator simulator(block, parameters);
  DrillingLogs logs;
  logs.watch_pieces();
  DrillingRows rows(simulator, logs, 1000.0);
  std::uint64_t sequence = 0;
  const auto tick = [&](const Eigen::Vector3d& place, std::uint32_t functions, double power) {
    bone::SimulatorInput input;
    input.tool.tip.position = place;
    input.functions = functions;
    input.power = power;
    simulator.tick(input);
    rows.log_pieces(++sequence);
  };
  const Eigen::Vector3d top(0.0, 0.0, 8e-3);
  const Eigen::Vector3d hole = top + simulator.plate(0)->holes().front().translation();
  simulator.begin(0);
  tick(top, bone::bit(bone::Function::kApply), 0.0);
  ASSERT_EQ(simulator.world().plates(), 1);
  tick(hole, bone::bit(bone::Function::kNextTool), 0.0);
  for (int i = 0; i < 5000; ++i) {  // 7 mm at 1.6 mm/s
    tick(hole, 0, 1.0);
  }
  tick(hole, bone::bit(bone::Function::kDetach), 0.0);
  ASSERT_FALSE(simulator.world().plate_is_on(0));
  std::vector<record::ScrewRow> screws;
  logs.screws.flush([&](std::span<const record::ScrewRow> some) {
    screws.insert(screws.end(), some.begin(), some.end());
  });
  ASSERT_EQ(screws.size(), 2u);
  EXPECT_GT(screws[0].purchase, 4e-3);
  EXPECT_EQ(screws[1].sequence, sequence);
  EXPECT_EQ(screws[1].plate, screws[0].plate);
  EXPECT_EQ(screws[1].hole, screws[0].hole);
  EXPECT_EQ(screws[1].depth, 0.0);
  EXPECT_EQ(screws[1].purchase, 0.0);
  EXPECT_EQ(difference(sequence, std::span(screws).last(1), simulator.screws()), "");
  EXPECT_THAT(difference(sequence, std::span(screws).first(1), simulator.screws()),
              HasSubstr("the screws are not those of the record"));
}

}  // namespace
}  // namespace haptrial::protocols
