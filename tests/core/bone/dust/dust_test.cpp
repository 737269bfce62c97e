#include "core/bone/dust/dust.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

constexpr double kEdge = 0.5e-3;  // of voxels and of cells [m]

/// Cells and voxels that coincide: W's axes, up along z, voxel (i, j, k) in cell (i, j, k).
DustParameters aligned() {
  DustParameters p;
  p.cell = kEdge;
  p.voxel = kEdge;
  p.up = Eigen::Vector3d::UnitZ();
  p.region = {Eigen::Vector3d::Constant(-0.05), Eigen::Vector3d::Constant(0.05)};
  return p;
}

Eigen::Vector3d middle(int i, int j, int k) {
  return kEdge * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
}

/// A volume with bone wherever `is_bone(i, j, k)`, voxel (i, j, k) around middle(i, j, k).
template <class F>
BoneVolume volume_of(int size, F&& is_bone) {
  BoneModel model;
  model.grid = {{size, size, size}, Eigen::Vector3d::Constant(0.5 * kEdge), kEdge};
  model.structures.resize(2);
  model.labels.resize(model.grid.count());
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        model.labels[model.grid.index(i, j, k)] = is_bone(i, j, k) ? 1 : 0;
      }
    }
  }
  return BoneVolume(model);
}

void expect_balanced(const Dust& dust) {
  const DustBalance b = dust.balance();
  EXPECT_EQ(b.deposited, b.lying + b.held + b.suctioned + b.fallen);  // exactly
}

double sum_of_cells(const Dust& dust, int low, int high) {
  double sum = 0.0;
  for (int k = low; k < high; ++k) {
    for (int j = low; j < high; ++j) {
      for (int i = low; i < high; ++i) {
        sum += dust.amount_at(middle(i, j, k));
      }
    }
  }
  return sum;
}

void settle(Dust& dust) {
  for (int i = 0; i < 20'000 && dust.active() > 0; ++i) {
    dust.step(dust.step_time());
  }
  EXPECT_EQ(dust.active(), 0U);
}

TEST(DustTest, FallsInAShaftAtTheStatedSpeedAndRests) {
  const BoneVolume bone =
      volume_of(40, [](int i, int j, int k) { return !(i == 20 && j == 20 && k >= 2); });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  dust.deposit({middle(20, 20, 38), 0.0, 0.3});
  dust.step(0.0);
  ASSERT_NEAR(dust.amount_at(middle(20, 20, 38)), 0.3, 1e-5);
  const double seconds = 0.04;
  dust.step(seconds);
  const int fallen = static_cast<int>(std::lround(aligned().fall_speed * seconds / kEdge));
  EXPECT_NEAR(dust.amount_at(middle(20, 20, 38 - fallen)), 0.3, 1e-5);
  settle(dust);
  EXPECT_NEAR(dust.amount_at(middle(20, 20, 2)), 0.3, 1e-5);
  EXPECT_EQ(dust.cells(), 1U);
  expect_balanced(dust);
}

TEST(DustTest, FillsAShaftFromTheBottom) {
  const BoneVolume bone =
      volume_of(24, [](int i, int j, int k) { return !(i == 12 && j == 12 && k >= 2); });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int i = 0; i < 10; ++i) {
    dust.deposit({middle(12, 12, 20), 0.0, 0.5});
    dust.step(0.1);
  }
  settle(dust);
  const double capacity = dust.capacity();
  for (int k = 2; k < 10; ++k) {
    EXPECT_NEAR(dust.amount_at(middle(12, 12, k)),
                std::clamp(5.0 - (k - 2) * capacity, 0.0, capacity), 1e-4)
        << k;
  }
}

/// Height of the pile in a column above the floor at k = 0 [cells].
double height(const Dust& dust, int i, int j) {
  double sum = 0.0;
  for (int k = 0; k < 60; ++k) {
    sum += dust.amount_at(middle(i, j, k)) / dust.capacity();
  }
  return sum;
}

class DustPileTest : public ::testing::TestWithParam<double> {};

TEST_P(DustPileTest, IsSymmetricAndAsSteepAsStated) {
  DustParameters p = aligned();
  p.slope = GetParam();
  p.region.min().z() = -2 * kEdge;
  Dust dust(p);
  BoneModel floor;
  floor.grid = {{160, 160, 1}, middle(-80, -80, -1), kEdge};
  floor.structures.resize(2);
  floor.labels.assign(floor.grid.count(), 1);
  const BoneVolume bone(floor);
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int i = 0; i < 400; ++i) {
    dust.deposit({middle(0, 0, 40), 0.0, 10.0});
    dust.step(0.02);
  }
  settle(dust);
  const double top = height(dust, 0, 0);
  ASSERT_GT(top, 8.0);
  int foot = 0;
  while (height(dust, foot, 0) > 0.0) {
    ++foot;
  }
  for (int j = 0; j < foot; ++j) {
    for (int i = 0; i < foot; ++i) {
      const double h = height(dust, i, j);
      EXPECT_EQ(h, height(dust, -i, j)) << i << ' ' << j;
      EXPECT_EQ(h, height(dust, i, -j)) << i << ' ' << j;
      EXPECT_EQ(h, height(dust, j, i)) << i << ' ' << j;
    }
  }
  // Heights along an axis and along a diagonal, from a little below the top to a little above the
  // foot.
  const int from = 2;
  const int to = foot - 3;
  ASSERT_GT(to, from + 4);
  const double slope = (height(dust, from, 0) - height(dust, to, 0)) / (to - from);
  EXPECT_NEAR(slope, p.slope, 0.05 * p.slope + 0.02);
  const int across = static_cast<int>(to / std::sqrt(2.0));
  const double diagonal = (height(dust, from, from) - height(dust, across, across)) /
                          ((across - from) * std::sqrt(2.0));
  EXPECT_NEAR(diagonal, p.slope, 0.12 * p.slope + 0.02);
  expect_balanced(dust);
}

INSTANTIATE_TEST_SUITE_P(Slopes, DustPileTest, ::testing::Values(0.3, 0.5, 0.65));

TEST(DustTest, StaysInAClosedShellHoweverTheBoneIsTurned) {
  RandomStream random(3, "shells");
  for (int trial = 0; trial < 4; ++trial) {
    // A sphere of one to two voxels' thickness, in a bone at any angle.
    const Eigen::Vector3d centre = middle(20, 20, 20) - Eigen::Vector3d::Constant(0.5 * kEdge);
    const BoneVolume bone = volume_of(42, [](int i, int j, int k) {
      const double r = std::sqrt((i - 20) * (i - 20) + (j - 20) * (j - 20) + (k - 20) * (k - 20));
      return r > 14.0 && r < 15.5;
    });
    const Eigen::Quaterniond turn(random.normal(), random.normal(), random.normal(),
                                  random.normal());
    DustBone pose{&bone, Eigen::Isometry3d(turn.normalized())};
    pose.X_WB.translation() = -(turn.normalized() * centre);  // the middle comes to W's origin
    Dust dust(aligned());
    dust.follow({&pose, 1});
    for (int i = 0; i < 40; ++i) {
      dust.deposit({Eigen::Vector3d::Zero(), 1e-3, 80.0});
      dust.step(0.05);
    }
    settle(dust);
    EXPECT_EQ(dust.balance().fallen, 0.0);
    EXPECT_GT(dust.balance().lying, 2000.0);
    std::vector<DustQuad> quads;
    dust.quads(quads);
    for (const DustQuad& quad : quads) {
      const Eigen::Vector3d at = quad.position.cast<double>();
      ASSERT_LT(at.norm(), 16.0 * kEdge) << trial;
    }
  }
}

TEST(DustTest, FallsWhenTheShelfBelowIsDrilledAway) {
  BoneVolume bone = volume_of(24, [](int, int, int k) { return k == 10 || k == 2; });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  dust.deposit({middle(12, 12, 14), 0.0, 2.0});
  dust.step(0.2);
  settle(dust);
  EXPECT_NEAR(sum_of_cells(dust, 0, 24), 2.0, 1e-4);
  EXPECT_GT(dust.amount_at(middle(12, 12, 11)), 0.0);
  for (int j = 9; j < 16; ++j) {
    for (int i = 9; i < 16; ++i) {
      bone.take(bone.address(Voxel(i, j, 10)), 1.0F);
    }
  }
  dust.follow(bones);
  EXPECT_GT(dust.active(), 0U);
  settle(dust);
  EXPECT_EQ(dust.amount_at(middle(12, 12, 11)), 0.0);
  EXPECT_GT(dust.amount_at(middle(12, 12, 3)), 0.0);
  expect_balanced(dust);
}

TEST(DustTest, AToolPushesDustOutOfItsWay) {
  const BoneVolume bone = volume_of(40, [](int, int, int k) { return k < 4; });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int i = 0; i < 30; ++i) {
    dust.deposit({middle(20, 20, 16), 1e-3, 30.0});
    dust.step(0.05);
  }
  settle(dust);
  DustTools tools;
  tools.tools[0] = {middle(20, 20, 6), Eigen::Vector3d::UnitZ(), 20e-3, 1.2e-3, false};
  double inside = 0.0;
  const auto count_inside = [&] {
    inside = 0.0;
    for (int k = 4; k < 30; ++k) {
      for (int j = 10; j < 30; ++j) {
        for (int i = 10; i < 30; ++i) {
          const Eigen::Vector3d off = middle(i, j, k) - tools.tools[0].tip;
          const Eigen::Vector3d to_axis(off.x(), off.y(), std::min(0.0, off.z()));
          inside += to_axis.norm() < 1.2e-3 ? dust.amount_at(middle(i, j, k)) : 0.0;
        }
      }
    }
  };
  count_inside();
  EXPECT_GT(inside, 20.0);
  dust.place(tools);
  dust.step(1.5);
  count_inside();
  EXPECT_LT(inside, 0.5);
  EXPECT_NEAR(dust.balance().lying, 900.0, 1e-4);
  // Dust flows back into the hole.
  dust.place({});
  settle(dust);
  tools.tools[0].length = 0.0;
  count_inside();
  EXPECT_GT(inside, 5.0);
}

/// The heights of columns [cells] in a basin that is walled and floored by bone.
std::vector<double> heights_in_basin(Dust& dust) {
  std::vector<double> heights;
  for (int i = 10; i < 20; ++i) {
    double height = 0.0;
    for (int k = 5; k < 25; ++k) {
      height += dust.amount_at(middle(i, 15, k)) / dust.capacity();
    }
    heights.push_back(height);
  }
  return heights;
}

/// Pours dust into a corner, until all is at rest.
void pour(Dust& dust) {
  for (int i = 0; i < 300; ++i) {
    dust.deposit({middle(12, 12, 9), 0.0, 1.0});
    dust.step(4.0 * dust.step_time());
  }
  settle(dust);
}

BoneVolume basin() {
  return volume_of(
      30, [](int i, int j, int k) { return k < 5 || i < 10 || i >= 20 || j < 10 || j >= 20; });
}

double unevenness(const std::vector<double>& heights) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  return *high - *low;
}

TEST(DustTest, ALiquidStandsLevelInABasinAndDryDustDoesNot) {
  const BoneVolume bone = basin();
  const DustBone bones[] = {{&bone, Eigen::Isometry3d::Identity()}};
  DustParameters p = aligned();
  p.bulking = 1.0;
  for (const double slope : {kLeastSlope, 0.6}) {
    p.slope = slope;
    Dust dust(p);
    dust.follow(bones);
    pour(dust);
    // Neighbours may differ by the slope, and by what is too little to flow.
    const double most = 9.0 * (kLeastSlope + 1.0 / 32.0);
    EXPECT_EQ(unevenness(heights_in_basin(dust)) <= most, slope == kLeastSlope);
    expect_balanced(dust);
  }
}

TEST(DustTest, WaterLetsAPileFlowWhereItRuns) {
  const BoneVolume bone = basin();
  const DustBone bones[] = {{&bone, Eigen::Isometry3d::Identity()}};
  DustParameters p = aligned();
  p.bulking = 1.0;
  p.slope = 0.6;
  Dust dust(p);
  dust.follow(bones);
  pour(dust);
  const double dry = unevenness(heights_in_basin(dust));
  DustTools tools;
  tools.water = {middle(25, 25, 9), 2.0 * kEdge};  // elsewhere
  dust.place(tools);
  settle(dust);
  EXPECT_EQ(unevenness(heights_in_basin(dust)), dry);
  tools.water = {middle(15, 15, 7), 20.0 * kEdge};
  dust.place(tools);
  settle(dust);
  EXPECT_LE(unevenness(heights_in_basin(dust)), 9.0 * (kLeastSlope + 1.0 / 32.0));
  EXPECT_GT(dry, 1.5);
  expect_balanced(dust);
}

TEST(DustTest, SuctionTakesAtItsRateAndNotThroughBone) {
  // Two rooms side by side, both full; the nozzle is in one of them.
  const BoneVolume bone = volume_of(40, [](int i, int j, int k) {
    return k < 4 || i == 20 || i < 10 || i > 30 || j < 10 || j > 30;
  });
  DustParameters p = aligned();
  p.suction_rate = 20.0 * kEdge * kEdge * kEdge;  // 20 voxels a second
  Dust dust(p);
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (const int i : {15, 25}) {
    for (int n = 0; n < 40; ++n) {
      dust.deposit({middle(i, 20, 20), 0.0, 20.0});
      dust.step(0.05);
    }
  }
  settle(dust);
  const auto in_far_room = [&] {
    double sum = 0.0;
    for (int k = 4; k < 40; ++k) {
      for (int j = 10; j <= 30; ++j) {
        for (int i = 21; i <= 30; ++i) {
          sum += dust.amount_at(middle(i, j, k));
        }
      }
    }
    return sum;
  };
  const double far = in_far_room();
  EXPECT_NEAR(far, 800.0, 1.0);
  DustTools tools;
  tools.tools[1] = {middle(18, 20, 6), Eigen::Vector3d::UnitZ(), 30e-3, 0.6e-3, true};
  dust.place(tools);
  dust.step(2.0);
  EXPECT_NEAR(dust.balance().suctioned, 40.0, 0.5);
  dust.step(200.0);
  EXPECT_EQ(in_far_room(), far);
  EXPECT_GT(dust.balance().suctioned, 300.0);
  expect_balanced(dust);
}

TEST(DustTest, WaterAtABurrCarriesDustOffAtItsRate) {
  const BoneVolume bone = volume_of(40, [](int i, int j, int k) {
    return k < 4 || i < 10 || i > 20 || j < 10 || j > 30;
  });
  DustParameters p = aligned();
  p.water_rate = 20.0 * kEdge * kEdge * kEdge;  // 20 voxels a second
  Dust dust(p);
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int n = 0; n < 40; ++n) {
    dust.deposit({middle(15, 20, 20), 0.0, 20.0});
    dust.step(0.05);
  }
  settle(dust);
  DustTools tools;
  tools.tools[0] = {middle(15, 20, 9), Eigen::Vector3d::UnitZ(), 30e-3, 1e-3, false, false};
  dust.place(tools);
  dust.step(2.0);
  EXPECT_EQ(dust.balance().suctioned, 0.0);  // a burr that rests has no water
  tools.tools[0].rinses = true;
  dust.place(tools);
  dust.step(2.0);
  EXPECT_NEAR(dust.balance().suctioned, 40.0, 0.5);
  expect_balanced(dust);
}

TEST(DustTest, NothingIsLostInLongRandomRuns) {
  for (int seed = 0; seed < 3; ++seed) {
    RandomStream random(seed, "dust");
    BoneVolume bone = volume_of(48, [](int i, int j, int k) {
      return k < 20 || (i - 24) * (i - 24) + (j - 24) * (j - 24) > 300;
    });
    DustParameters p = aligned();
    p.region = {Eigen::Vector3d::Constant(-2e-3), Eigen::Vector3d::Constant(26e-3)};
    p.up = Eigen::Vector3d(random.normal(), random.normal(), 3.0);
    Dust dust(p);
    DustBone pose{&bone};
    double given = 0.0;
    for (int round = 0; round < 200; ++round) {
      const Eigen::Vector3d at =
          middle(12 + static_cast<int>(random.below(24)), 12 + static_cast<int>(random.below(24)),
                 12 + static_cast<int>(random.below(24)));
      for (int n = 0; n < 40; ++n) {
        const Voxel voxel(static_cast<int>(random.below(48)), static_cast<int>(random.below(48)),
                          static_cast<int>(random.below(48)));
        if (const auto where = bone.address(voxel); where != 0) {
          const double amount = bone.take(where, 1.0F);
          given += amount;
          dust.deposit({at, random.uniform(0.0, 2e-3), amount});
        }
      }
      if (round % 40 == 39) {
        pose.X_WB.translation() = 1e-3 * Eigen::Vector3d(random.normal(), random.normal(), 0.0);
      }
      dust.follow({&pose, 1});
      DustTools tools;
      tools.tools[0] = {at, Eigen::Vector3d::UnitZ(), 10e-3, 1e-3, false};
      tools.tools[1] = {middle(24, 24, 22), Eigen::Vector3d::UnitX(), 20e-3, 1e-3, round % 3 == 0};
      dust.place(tools);
      dust.step(random.uniform(0.0, 0.03));
      const DustBalance b = dust.balance();
      ASSERT_EQ(b.deposited, b.lying + b.held + b.suctioned + b.fallen);
      ASSERT_NEAR(b.deposited, given, 2.0 * 0x1p-20);
    }
    EXPECT_GT(dust.balance().suctioned, 1.0);
    EXPECT_GT(dust.balance().lying, 100.0);
    dust.follow({});  // without bone all of it falls out
    dust.place({});
    for (int n = 0; n < 100; ++n) {
      dust.step(0.02);
    }
    const DustBalance b = dust.balance();
    EXPECT_EQ(b.lying, 0.0);
    EXPECT_EQ(b.deposited, b.held + b.suctioned + b.fallen);
  }
}

/// Everything that can be seen of a run in which steps are cut as `parts` says.
std::vector<DustQuad> run_in_parts(int parts) {
  const BoneVolume bone = volume_of(32, [](int, int, int k) { return k < 8; });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int n = 0; n < 20; ++n) {
    dust.deposit({middle(10 + n % 3, 16, 20), 1e-3, 7.0});
    for (int part = 0; part < parts; ++part) {
      dust.step(24.0 * dust.step_time() / parts);
    }
  }
  std::vector<DustQuad> quads;
  dust.quads(quads);
  return quads;
}

TEST(DustTest, TheSameCallsGiveTheSameDustAndTimeMayBeCut) {
  const auto equal = [](const DustQuad& a, const DustQuad& b) {
    return a.position == b.position && a.size == b.size && a.alpha == b.alpha;
  };
  const auto once = run_in_parts(1);
  const auto again = run_in_parts(1);
  const auto cut = run_in_parts(6);
  EXPECT_TRUE(std::equal(once.begin(), once.end(), again.begin(), again.end(), equal));
  const auto key = [](const DustQuad& q) {
    return std::array{q.position.x(), q.position.y(), q.position.z()};
  };
  std::map<std::array<float, 3>, float> places;
  for (const DustQuad& quad : once) {
    places[key(quad)] = quad.size;
  }
  EXPECT_EQ(places.size(), cut.size());
  for (const DustQuad& quad : cut) {
    EXPECT_EQ(places[key(quad)], quad.size);
  }
}

TEST(DustTest, ATrickleIsDrawnWhereItLiesAndNotWhileItFalls) {
  const BoneVolume bone = volume_of(32, [](int, int, int k) { return k < 8; });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int n = 0; n < 60; ++n) {
    dust.deposit({middle(16, 16, 28), 1e-3, 0.5});
    dust.step(dust.step_time());
  }
  EXPECT_GT(dust.amount_at(middle(16, 16, 18)), 0.0) << "in the air";
  std::vector<DustQuad> quads;
  dust.quads(quads);
  ASSERT_FALSE(quads.empty());
  std::size_t in_air = 0;
  for (const DustQuad& quad : quads) {
    const double height = quad.position.z() - middle(16, 16, 8).z();
    in_air += height > 5.0 * kEdge && height < 15.0 * kEdge ? 1 : 0;
  }
  EXPECT_EQ(in_air, 0u);
}

TEST(DustTest, OnlyCellsWithFullCellsAtAllFacesAreLeftOutOfThePicture) {
  const BoneVolume bone = volume_of(32, [](int i, int j, int k) {
    return k < 8 || std::min({i, j, 31 - i, 31 - j}) < 8;  // a pit
  });
  Dust dust(aligned());
  const DustBone bones[] = {{&bone}};
  dust.follow(bones);
  for (int n = 0; n < 60; ++n) {
    dust.deposit({middle(16, 16, 24), 1e-3, 30.0});
    dust.step(24.0 * dust.step_time());
  }
  std::vector<DustQuad> quads;
  dust.quads(quads);
  const auto at = [&](const Eigen::Vector3d& p) { return dust.amount_at(p) / dust.capacity(); };
  std::set<std::array<int, 3>> drawn;
  const auto key = [](const Eigen::Vector3d& p) {
    const Eigen::Array3i cell = (p.array() / kEdge).floor().cast<int>();
    return std::array{cell.x(), cell.y(), cell.z()};
  };
  for (const DustQuad& quad : quads) {
    drawn.insert(key(quad.position.cast<double>()));
  }
  int buried = 0;
  for (int k = 0; k < 32; ++k) {
    for (int j = 0; j < 32; ++j) {
      for (int i = 0; i < 32; ++i) {
        const Eigen::Vector3d p = middle(i, j, k);
        double least = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
          const Eigen::Vector3d step = kEdge * Eigen::Vector3d::Unit(axis);
          least = std::min({least, at(p + step), at(p - step)});
        }
        if (at(p) > 0.01) {
          EXPECT_EQ(drawn.contains(key(p)), least < 0.5) << i << ", " << j << ", " << k;
          buried += least < 0.5 ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GT(buried, 5);
}

TEST(DustTest, NoDustCostsNothingAndMemoryIsBounded) {
  DustParameters p = aligned();
  p.max_blocks = 8;
  Dust dust(p);
  dust.step(1e6);  // returns at once
  EXPECT_EQ(dust.blocks(), 0U);
  for (int n = 0; n < 100; ++n) {
    dust.deposit({middle(0, 0, 0), 0.0, 100.0});
    dust.step(1e-3);
    EXPECT_LE(dust.blocks(), 8U);
    expect_balanced(dust);
  }
  EXPECT_GT(dust.balance().held, 0.0);
  for (int n = 0; n < 1000; ++n) {
    dust.step(0.1);
  }
  expect_balanced(dust);
  EXPECT_EQ(dust.balance().lying, 0.0);  // there is no floor
  EXPECT_EQ(dust.balance().fallen, dust.balance().deposited);
  EXPECT_EQ(dust.blocks(), 0U);
}

TEST(DustTest, DustUnderAMovedBoneComesOut) {
  const BoneVolume bone = volume_of(24, [](int, int, int k) { return k < 6; });
  Dust dust(aligned());
  DustBone pose{&bone};
  dust.follow({&pose, 1});
  dust.deposit({middle(12, 12, 10), 0.0, 5.0});
  settle(dust);
  dust.step(0.1);
  settle(dust);
  pose.X_WB.translation().z() = kEdge;  // the floor rises by a cell
  dust.follow({&pose, 1});
  settle(dust);
  double buried = 0.0;
  for (int j = 0; j < 24; ++j) {
    for (int i = 0; i < 24; ++i) {
      buried += dust.amount_at(middle(i, j, 6));
    }
  }
  EXPECT_LT(buried, 0.01);
  expect_balanced(dust);
}

TEST(DustTest, ParametersOutOfBoundsAreRefused) {
  const auto refused = [](auto&& change) {
    DustParameters p = aligned();
    change(p);
    EXPECT_THROW(Dust{p}, std::invalid_argument);
  };
  refused([](DustParameters& p) { p.cell = 0.0; });
  refused([](DustParameters& p) { p.cell = 100.0 * p.voxel; });
  refused([](DustParameters& p) { p.slope = 0.8; });
  refused([](DustParameters& p) { p.bulking = 0.5; });
  refused([](DustParameters& p) { p.up.setZero(); });
  refused([](DustParameters& p) { p.region.setEmpty(); });
  refused([](DustParameters& p) { p.max_blocks = 0; });
  Dust dust(aligned());
  EXPECT_THROW(dust.deposit({{0, 0, 0}, 0.0, -1.0}), std::invalid_argument);
  EXPECT_THROW(dust.step(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::bone
