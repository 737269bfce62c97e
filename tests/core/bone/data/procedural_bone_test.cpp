// Laws of anatomy, held over seeds. Numbers are from the texts that
// docs/algorithms/procedural-bones.md cites, or measured on real bones.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/ear_anatomy.h"
#include "core/bone/data/procedural_bone.h"
#include "tests/core/bone/data/made_bones.h"

namespace haptrial::bone::temporal_bone_test {
namespace {

using test::places_of;

constexpr std::array<std::uint64_t, 4> kSeeds{1, 2, 3, 77};

const BoneModel& made(std::uint64_t seed) {
  static std::map<std::uint64_t, BoneModel> models;
  const auto found = models.find(seed);
  if (found != models.end()) {
    return found->second;
  }
  return models.emplace(seed, make_temporal_bone({.seed = seed})).first->second;
}

double volume_of(const BoneModel& model, Anatomy label) {
  return static_cast<double>(places_of(model, label).size()) *
         std::pow(1e3 * model.grid.spacing, 3);
}

TEST(TemporalBoneTest, EveryStructureIsThereAndNervesAreInOnePiece) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneSummary summary = summary_of(made(seed));
    std::map<int, std::size_t> pieces;
    for (const StructureSummary& one : summary.structures) {
      pieces[one.label] = one.pieces;
    }
    for (int label = 1; label <= static_cast<int>(Anatomy::kEarCanal); ++label) {
      EXPECT_TRUE(pieces.contains(label)) << "seed " << seed << ", label " << label;
    }
    for (const Anatomy one :
         {Anatomy::kFacialNerve, Anatomy::kCarotid, Anatomy::kLabyrinth, Anatomy::kMalleus,
          Anatomy::kIncus, Anatomy::kStapes, Anatomy::kEarCanal}) {
      EXPECT_EQ(pieces[static_cast<int>(one)], 1U)
          << "seed " << seed << ", label " << static_cast<int>(one);
    }
  }
}

TEST(TemporalBoneTest, VolumesAreThoseOfRealEars) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& model = made(seed);
    // Bony labyrinth: 138 and 197 mm3 in two labelled ears.
    EXPECT_GT(volume_of(model, Anatomy::kLabyrinth), 100.0) << seed;
    EXPECT_LT(volume_of(model, Anatomy::kLabyrinth), 260.0) << seed;
    // Internal auditory canal with its nerves: 74 to 502 mm3.
    double canal = volume_of(model, Anatomy::kInternalCanal);
    for (const Anatomy nerve : {Anatomy::kCochlearNerve, Anatomy::kSuperiorVestibularNerve,
                                Anatomy::kInferiorVestibularNerve}) {
      canal += volume_of(model, nerve);
    }
    EXPECT_GT(canal, 74.0) << seed;
    EXPECT_LT(canal, 502.0) << seed;
    // Bone of the two labelled blocks of the same size: 13.9 and 19.7 cm3.
    EXPECT_GT(volume_of(model, Anatomy::kBone), 10e3) << seed;
    EXPECT_LT(volume_of(model, Anatomy::kBone), 27e3) << seed;
    // Malleus 10 to 11, incus 12 to 13, stapes 2 mm3 there; half a millimetre is coarse for them.
    EXPECT_NEAR(volume_of(model, Anatomy::kMalleus), 10.5, 6.0) << seed;
    EXPECT_NEAR(volume_of(model, Anatomy::kIncus), 12.5, 6.0) << seed;
    EXPECT_NEAR(volume_of(model, Anatomy::kStapes), 2.0, 3.0) << seed;
  }
}

TEST(TemporalBoneTest, TheFacialNerveRunsAsLongAndAsFarFromItsNeighboursAsItShould) {
  for (const std::uint64_t seed : kSeeds) {
    const EarVariation v = ear_variation(seed);
    const EarAnatomy anatomy(v, 0.45);
    const auto& beads = anatomy.facial_nerve().beads();
    constexpr std::size_t kSteps = 8;  // between landmarks
    const auto length = [&](std::size_t from, std::size_t to) {
      double sum = 0.0;
      for (std::size_t i = from * kSteps; i < to * kSteps; ++i) {
        sum += (beads[i + 1].at - beads[i].at).norm();
      }
      return v.scale * sum;
    };
    EXPECT_NEAR(length(1, 2), 2.89, 1.5) << seed;   // labyrinthine
    EXPECT_NEAR(length(2, 4), 10.44, 2.9) << seed;  // tympanic: mean and two deviations
    EXPECT_NEAR(length(4, 6), 13.33, 4.4) << seed;  // mastoid: likewise
    const Eigen::Vector3d genu = beads[4 * kSteps].at;
    const Eigen::Vector3d before = (beads[2 * kSteps].at - genu).normalized();
    const Eigen::Vector3d after = (beads[6 * kSteps].at - genu).normalized();
    const double angle = std::acos(before.dot(after)) * 180.0 / std::numbers::pi;
    EXPECT_GT(angle, 95.0) << seed;
    EXPECT_LT(angle, 137.0) << seed;  // 117.8 and two deviations of 9.6
    const BoneModel& model = made(seed);
    const auto nerve = places_of(model, Anatomy::kFacialNerve);
    const double to_canal = test::gap_between(nerve, places_of(model, Anatomy::kEarCanal));
    EXPECT_GT(to_canal, 1.5) << seed;
    EXPECT_LT(to_canal, 8.0) << seed;
    EXPECT_GT(test::gap_between(nerve, places_of(model, Anatomy::kLabyrinth)), 0.4) << seed;
    EXPECT_LT(test::gap_between(nerve, places_of(model, Anatomy::kLabyrinth)), 2.5) << seed;
  }
}

TEST(TemporalBoneTest, TheChordaLeavesTheNerveAndPassesBetweenMalleusAndIncus) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& model = made(seed);
    const auto chorda = places_of(model, Anatomy::kChordaTympani);
    ASSERT_FALSE(chorda.empty());
    EXPECT_LT(test::gap_between(chorda, places_of(model, Anatomy::kFacialNerve)), 1.0) << seed;
    EXPECT_LT(test::gap_between(chorda, places_of(model, Anatomy::kMalleus)), 1.6) << seed;
    EXPECT_LT(test::gap_between(chorda, places_of(model, Anatomy::kIncus)), 1.6) << seed;
  }
}

TEST(TemporalBoneTest, TheOssiclesFormAChainToTheLabyrinth) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& model = made(seed);
    const auto incus = places_of(model, Anatomy::kIncus);
    const auto stapes = places_of(model, Anatomy::kStapes);
    EXPECT_LT(test::gap_between(places_of(model, Anatomy::kMalleus), incus), 1.2) << seed;
    EXPECT_LT(test::gap_between(incus, stapes), 1.2) << seed;
    EXPECT_LT(test::gap_between(stapes, places_of(model, Anatomy::kLabyrinth)), 1.2) << seed;
  }
}

TEST(TemporalBoneTest, SinusAndCanalLieAsFarApartAsTheyShould) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& model = made(seed);
    const double gap = test::gap_between(places_of(model, Anatomy::kSinusAndDura),
                                         places_of(model, Anatomy::kEarCanal));
    EXPECT_GT(gap, 4.0) << seed;
    EXPECT_LT(gap, 19.0) << seed;
  }
}

/// A cell beside the dura, face to face, would be a dehiscence.
TEST(TemporalBoneTest, AirInTheBoneDoesNotTouchDuraOrVesselsOrLabyrinth) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& model = made(seed);
    const geometry::VoxelGrid& grid = model.grid;
    // Outside: what can be reached from the border of the box without crossing anything.
    std::vector<bool> outside(grid.count());
    std::vector<std::array<int, 3>> open;
    const auto reach = [&](int i, int j, int k) {
      if (i < 0 || j < 0 || k < 0 || i >= grid.size[0] || j >= grid.size[1] || k >= grid.size[2]) {
        return;
      }
      const std::size_t index = grid.index(i, j, k);
      if (model.labels[index] != 0 || outside[index]) {
        return;
      }
      outside[index] = true;
      open.push_back({i, j, k});
    };
    for (int a = 0; a < std::max({grid.size[0], grid.size[1], grid.size[2]}); ++a) {
      for (int b = 0; b < std::max({grid.size[0], grid.size[1], grid.size[2]}); ++b) {
        reach(0, a, b), reach(grid.size[0] - 1, a, b), reach(a, 0, b);
        reach(a, grid.size[1] - 1, b), reach(a, b, 0), reach(a, b, grid.size[2] - 1);
      }
    }
    while (!open.empty()) {
      const auto [i, j, k] = open.back();
      open.pop_back();
      reach(i - 1, j, k), reach(i + 1, j, k), reach(i, j - 1, k);
      reach(i, j + 1, k), reach(i, j, k - 1), reach(i, j, k + 1);
    }
    std::size_t air = 0;
    std::size_t touching = 0;
    for (int k = 1; k + 1 < grid.size[2]; ++k) {
      for (int j = 1; j + 1 < grid.size[1]; ++j) {
        for (int i = 1; i + 1 < grid.size[0]; ++i) {
          const std::size_t index = grid.index(i, j, k);
          if (model.labels[index] != 0 || outside[index]) {
            continue;
          }
          ++air;
          for (const std::size_t next :
               {grid.index(i - 1, j, k), grid.index(i + 1, j, k), grid.index(i, j - 1, k),
                grid.index(i, j + 1, k), grid.index(i, j, k - 1), grid.index(i, j, k + 1)}) {
            const auto label = static_cast<Anatomy>(model.labels[next]);
            touching += label == Anatomy::kSinusAndDura || label == Anatomy::kLabyrinth ||
                        label == Anatomy::kCarotid || label == Anatomy::kInternalCanal;
          }
        }
      }
    }
    EXPECT_GT(air, 100U) << seed;
    EXPECT_EQ(touching, 0U) << seed;
  }
}

TEST(TemporalBoneTest, SeedsVaryAndThreadsDoNot) {
  const BoneModel one = make_temporal_bone({.seed = 5, .spacing = 1e-3, .threads = 1});
  const BoneModel two = make_temporal_bone({.seed = 5, .spacing = 1e-3, .threads = 3});
  EXPECT_EQ(one.labels, two.labels);
  EXPECT_EQ(one.density, two.density);
  EXPECT_NE(one.labels, make_temporal_bone({.seed = 6, .spacing = 1e-3}).labels);
  std::set<std::size_t> counts;
  for (const std::uint64_t seed : kSeeds) {
    counts.insert(summary_of(made(seed)).voxels);
  }
  EXPECT_EQ(counts.size(), kSeeds.size());
  EXPECT_THROW(make_temporal_bone({.spacing = 5e-3}), InputError);
}

}  // namespace
}  // namespace haptrial::bone::temporal_bone_test

namespace haptrial::bone::mandible_test {
namespace {

// Laws of anatomy, held over seeds; numbers as docs/algorithms/procedural-bones.md cites them.

using test::places_of;

constexpr double kSpacing = 0.8e-3;

const BoneModel& made(std::uint64_t seed) {
  static std::map<std::uint64_t, BoneModel> models;
  const auto found = models.find(seed);
  if (found != models.end()) {
    return found->second;
  }
  return models.emplace(seed, make_mandible({.seed = seed, .spacing = kSpacing})).first->second;
}

TEST(MandibleTest, BoneIsOnePieceWithANerveOnEachSide) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const StructureSummary& one : summary_of(made(seed)).structures) {
      if (one.label == static_cast<int>(Anatomy::kBone)) {
        EXPECT_EQ(one.pieces, 1U) << seed;
      }
      if (one.label == static_cast<int>(Anatomy::kAlveolarNerve)) {
        EXPECT_EQ(one.pieces, 2U) << seed;
      }
    }
  }
}

TEST(MandibleTest, ItIsAsLargeAsMandiblesAre) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    double condyles = 0.0;
    double angles = 0.0;
    double top = 0.0;
    for (const Eigen::Vector3d& p : places_of(made(seed), Anatomy::kBone)) {
      if (p.z() > 60.0) {
        condyles = std::max(condyles, p.x());
      }
      if (p.z() < 22.0 && p.y() > 60.0) {
        angles = std::max(angles, p.x());
      }
      top = std::max(top, p.z());
    }
    EXPECT_NEAR(2.0 * condyles, 118.0, 14.0) << seed;
    EXPECT_NEAR(2.0 * angles, 101.6, 15.0) << seed;
    EXPECT_NEAR(top, 68.0, 10.0) << seed;
    const double volume = summary_of(made(seed)).volume * 1e6;  // [cm3]
    EXPECT_GT(volume, 40.0) << seed;
    EXPECT_LT(volume, 110.0) << seed;
  }
}

TEST(MandibleTest, TheNerveIsCoveredByBoneInTheBodyAndLiesBelowTheRoots) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const BoneModel& model = made(seed);
    const auto nerve = places_of(model, Anatomy::kAlveolarNerve);
    const auto teeth = places_of(model, Anatomy::kTooth);
    EXPECT_GT(test::gap_between(nerve, teeth), 0.9) << seed;
    const geometry::VoxelGrid& grid = model.grid;
    for (const Eigen::Vector3d& p : nerve) {
      if (p.y() < 34.0 || p.y() > 55.0) {
        continue;
      }  // between the foramina
      // Down, in, out and up from it there is bone within 12 mm, before any opening.
      for (const Eigen::Vector3d& way :
           {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0)}) {
        bool bone = false;
        for (double step = 0.0; step < 12.0 && !bone; step += 0.4) {
          const Eigen::Vector3d at = 1e-3 * (p + step * way);
          const Eigen::Vector3d voxel = (at - grid.origin) / grid.spacing;
          const auto label = model.labels[grid.index(static_cast<int>(std::lround(voxel.x())),
                                                     static_cast<int>(std::lround(voxel.y())),
                                                     static_cast<int>(std::lround(voxel.z())))];
          ASSERT_NE(label, 0) << seed << ": open at " << p.transpose();
          bone = label == static_cast<int>(Anatomy::kBone);
        }
        EXPECT_TRUE(bone);
      }
    }
  }
}

TEST(MandibleTest, CortexIsDenseAndMarrowIsNot) {
  const BoneModel& model = made(1);
  std::size_t dense = 0;
  std::size_t light = 0;
  for (std::size_t i = 0; i < model.labels.size(); ++i) {
    if (model.labels[i] != static_cast<int>(Anatomy::kBone)) {
      continue;
    }
    dense += model.density[i] == 1.0F;
    light += model.density[i] < 0.6F;
  }
  EXPECT_GT(dense, 10000U);
  EXPECT_GT(light, 10000U);
}

TEST(MandibleTest, SidesMirrorSeedsVaryAndThreadsDoNot) {
  const BoneModel one = make_mandible({.seed = 4, .spacing = 2e-3, .threads = 1});
  EXPECT_EQ(one.labels, make_mandible({.seed = 4, .spacing = 2e-3, .threads = 4}).labels);
  EXPECT_NE(one.labels, make_mandible({.seed = 5, .spacing = 2e-3}).labels);
  const auto nerve = places_of(made(1), Anatomy::kAlveolarNerve);
  EXPECT_LT(std::abs(test::middle_of(nerve).x()), 1.0);
  EXPECT_THROW(make_mandible({.spacing = 0.1e-3}), InputError);
}

}  // namespace
}  // namespace haptrial::bone::mandible_test
