#include "core/bone/model/occupancy.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone {
namespace {

std::set<std::int32_t> filled(const BoneVolume& volume) {
  std::set<std::int32_t> all;
  for (std::int32_t at = 0; at < volume.bricks() * BoneVolume::kBrickVoxels; ++at) {
    if (volume.density(at) > 0.0F) {
      all.insert(at);
    }
  }
  return all;
}

/// A follower's set, kept by nothing but what follow() reports.
class Reported {
 public:
  explicit Reported(const BoneVolume& volume) : volume_(volume) {}

  std::size_t follow() {
    changed_.clear();
    bricks_.clear();
    occupancy_.follow(volume_, changed_, &bricks_);
    for (const Voxel& voxel : changed_) {
      const std::int32_t at = volume_.address(voxel);
      if (!set_.erase(at)) {
        set_.insert(at);
      }
    }
    return changed_.size();
  }

  const BoneVolume& volume_;
  Occupancy occupancy_;
  std::vector<Voxel> changed_;
  std::vector<std::int32_t> bricks_;
  std::set<std::int32_t> set_;
};

BoneModel ball() {
  return test::solid_bone(32, 1e-3, [](const Eigen::Vector3d& p) { return p.norm() < 11e-3; });
}

TEST(OccupancyTest, TheFirstFollowReportsEverything) {
  const BoneVolume volume(ball());
  Reported reported(volume);
  EXPECT_FALSE(reported.occupancy_.holds(1000));
  reported.follow();
  EXPECT_EQ(reported.set_, filled(volume));
  EXPECT_EQ(reported.occupancy_.count(), reported.set_.size());
  EXPECT_EQ(reported.follow(), 0U);
  EXPECT_TRUE(reported.bricks_.empty());
}

TEST(OccupancyTest, ReportsWhatWasFilledAndEmptiedSince) {
  BoneVolume volume(ball());
  Reported reported(volume);
  reported.follow();
  RandomStream random(1, "carving");
  for (int round = 0; round < 50; ++round) {
    std::set<std::int32_t> bricks;
    for (std::uint64_t n = random.below(40); n > 0; --n) {
      const auto at = static_cast<std::int32_t>(512 + random.below(512 * (volume.bricks() - 1)));
      bricks.insert(at / 512);
      if (random.below(3) == 0) {
        volume.put(at, 0.7F);
      } else {
        volume.take(at, 0.6F);  // thins, or empties
      }
    }
    reported.follow();
    EXPECT_EQ(std::set<std::int32_t>(reported.bricks_.begin(), reported.bricks_.end()), bricks);
    const auto truth = filled(volume);
    EXPECT_EQ(reported.set_, truth);
    EXPECT_EQ(reported.occupancy_.count(), truth.size());
    for (std::int32_t at = 0; at < volume.bricks() * 512; ++at) {
      ASSERT_EQ(reported.occupancy_.holds(at), truth.contains(at));
    }
  }
}

TEST(OccupancyTest, TwoFollowersDoNotTakeFromEachOther) {
  BoneVolume volume(ball());
  Reported often(volume);
  Reported seldom(volume);
  for (std::int32_t at = 512; at < volume.bricks() * 512; at += 7) {
    volume.take(at, 1.0F);
    if (at % 49 == 0) {
      often.follow();
    }
  }
  often.follow();
  seldom.follow();
  EXPECT_EQ(often.set_, filled(volume));
  EXPECT_EQ(seldom.set_, often.set_);
}

TEST(OccupancyTest, NothingIsMissedBesideAWriter) {
  BoneVolume volume(ball());
  const auto addresses = static_cast<std::uint64_t>(volume.bricks()) * 512 - 512;
  constexpr int kRounds = 100;
  std::atomic<int> rounds{0};
  std::atomic<bool> done{false};
  std::thread writer([&] {
    RandomStream random(2, "writer");
    for (int n = 0; n < 200000 || rounds.load() < kRounds; ++n) {
      const auto at = static_cast<std::int32_t>(512 + random.below(addresses));
      if (random.below(2) == 0) {
        volume.put(at, 1.0F);
      } else {
        volume.take(at, 1.0F);
      }
    }
    done.store(true);
  });
  Reported reported(volume);
  while (!done.load()) {
    reported.follow();
    ++rounds;
  }
  writer.join();
  reported.follow();
  EXPECT_EQ(reported.set_, filled(volume));
  EXPECT_EQ(reported.occupancy_.count(), reported.set_.size());
}

}  // namespace
}  // namespace haptrial::bone
