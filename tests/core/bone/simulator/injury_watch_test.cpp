#include "core/bone/simulator/injury_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace haptrial::bone::injury_watch_test {
namespace {

const std::vector<Structure> kStructures{
    {}, {"bone", {}}, {"facial nerve", {}, 0.25, true}, {"dura", {}, 0.25, true}};
constexpr double kTick = 1e-3;

EmptiedIn voxel_of(std::uint8_t label) {
  EmptiedIn gone;
  gone.label = label;
  return gone;
}

TEST(InjuryWatchTest, TheFirstVoxelOfAVitalStructureIsAnInjuryOnItsTick) {
  InjuryWatch watch(kStructures);
  watch.tick(std::vector{voxel_of(1)}, {}, kTick);
  EXPECT_EQ(watch.last().label, 0) << "bone is there to be removed";
  watch.tick(std::vector{voxel_of(1), voxel_of(2)}, {}, kTick);
  EXPECT_EQ(watch.last().label, 2);
  EXPECT_EQ(watch.last().since, 0.0);
  for (int i = 0; i < 500; ++i) {
    watch.tick({}, {}, kTick);
  }
  EXPECT_NEAR(watch.last().since, 0.5, 1e-9);
  Tear tear;
  tear.label = 3;
  watch.tick({}, std::vector{tear}, kTick);
  EXPECT_EQ(watch.last().label, 3);
}

TEST(InjuryWatchTest, LossesThatFollowEachOtherAreOneInjury) {
  const LastInjury none;
  const double soon = 0.5 * kOneInjury;
  const double late = 1.5 * kOneInjury;
  EXPECT_FALSE(begins(none, none));
  EXPECT_TRUE(begins(none, {2, 0.0}));
  EXPECT_FALSE(begins({2, 0.0}, {2, 0.0}));
  EXPECT_FALSE(begins({2, soon}, {2, 0.0}));
  EXPECT_TRUE(begins({2, late}, {2, 0.0}));
  EXPECT_TRUE(begins({2, soon}, {3, 0.0})) << "another structure";
  EXPECT_FALSE(begins({2, soon}, {2, soon + kTick})) << "nothing happened";
}

}  // namespace
}  // namespace haptrial::bone::injury_watch_test
