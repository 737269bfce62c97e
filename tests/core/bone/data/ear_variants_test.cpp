// Each variant of a made ear beside the plain one of the same seed, by counts of voxels and
// distances between voxels that know nothing of the shapes. And on which side
// an ear is, and the names of its parts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/procedural_bone.h"
#include "tests/core/bone/data/made_bones.h"

namespace haptrial::bone {
namespace {

using test::places_of;

constexpr std::array<std::uint64_t, 1> kSeeds{1};

const BoneModel& ear(std::uint64_t seed, const std::string& variant = "") {
  static std::map<std::pair<std::uint64_t, std::string>, BoneModel> made;
  const auto key = std::pair(seed, variant);
  const auto found = made.find(key);
  return found != made.end()
             ? found->second
             : made.emplace(key, make_temporal_bone({.seed = seed, .variant = variant}))
                   .first->second;
}

/// Lowest dura over the mastoid behind and beside the middle ear [mm].
double lowest_roof(const BoneModel& model) {
  const Eigen::Vector3d incus = test::middle_of(places_of(model, Anatomy::kIncus));
  double lowest = 1e9;
  for (const Eigen::Vector3d& p : places_of(model, Anatomy::kSinusAndDura)) {
    const Eigen::Vector3d from = p - incus;
    // In front of the sinus, behind the incus, to the side of it.
    if (from.x() < -6.0 && from.y() > 2.0 && from.y() < 10.0) {
      lowest = std::min(lowest, p.z());
    }
  }
  return lowest;
}

/// From the sinus to the ear canal, below the roof, whose dura has the same label [mm].
double sinus_to_canal(const BoneModel& model) {
  const double roof = test::middle_of(places_of(model, Anatomy::kIncus)).z() - 4.0;
  std::vector<Eigen::Vector3d> sinus = places_of(model, Anatomy::kSinusAndDura);
  std::erase_if(sinus, [roof](const Eigen::Vector3d& p) { return p.z() > roof; });
  return test::gap_between(sinus, places_of(model, Anatomy::kEarCanal));
}

/// Air that bone encloses in a ball about a place [mm3].
double air_within(const BoneModel& model, const Eigen::Vector3d& middle, double radius) {
  double count = 0.0;
  for (const Eigen::Vector3d& p : places_of(model, Anatomy::kNothing)) {
    count += (p - middle).norm() < radius ? 1.0 : 0.0;
  }
  return count * std::pow(1e3 * model.grid.spacing, 3);
}

Eigen::Vector3d antrum_of(const BoneModel& model) {
  return test::middle_of(places_of(model, Anatomy::kIncus)) + Eigen::Vector3d(-2.0, 7.0, 1.0);
}

/// Faces of voxels of the facial nerve that air touches.
int bare_faces(const BoneModel& model) {
  const geometry::VoxelGrid& grid = model.grid;
  int faces = 0;
  for (int k = 1; k + 1 < grid.size[2]; ++k) {
    for (int j = 1; j + 1 < grid.size[1]; ++j) {
      for (int i = 1; i + 1 < grid.size[0]; ++i) {
        if (model.labels[grid.index(i, j, k)] != static_cast<std::uint8_t>(Anatomy::kFacialNerve)) {
          continue;
        }
        for (const Eigen::Array3i& to :
             {Eigen::Array3i(1, 0, 0), Eigen::Array3i(-1, 0, 0), Eigen::Array3i(0, 1, 0),
              Eigen::Array3i(0, -1, 0), Eigen::Array3i(0, 0, 1), Eigen::Array3i(0, 0, -1)}) {
          const Eigen::Array3i beside = Eigen::Array3i(i, j, k) + to;
          // Within the bone: where the nerve leaves it, it lies in the open in every ear.
          const double height = 1e3 * grid.centre(i, j, k).z();
          const bool open = model.labels[grid.index(beside)] == 0;
          faces += open && height > 16.0 ? 1 : 0;
        }
      }
    }
  }
  return faces;
}

double dense_share(const BoneModel& model) {
  double dense = 0.0;
  double all = 0.0;
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    if (model.labels[at] == static_cast<std::uint8_t>(Anatomy::kBone)) {
      all += 1.0;
      dense += model.density[at] > 0.9F ? 1.0 : 0.0;
    }
  }
  return dense / all;
}

TEST(EarVariantsTest, ALowTegmenHangsLowOverTheMastoid) {
  for (const std::uint64_t seed : kSeeds) {
    EXPECT_LT(lowest_roof(ear(seed, "low tegmen")), lowest_roof(ear(seed)) - 2.5) << seed;
  }
}

TEST(EarVariantsTest, AForwardSinusLiesNearTheEarCanal) {
  for (const std::uint64_t seed : kSeeds) {
    const double plain = sinus_to_canal(ear(seed));
    const double forward = sinus_to_canal(ear(seed, "forward sinus"));
    EXPECT_LT(forward, plain - 2.0) << seed;
    EXPECT_GT(forward, 1.0) << seed << ": there is bone between them";
  }
}

TEST(EarVariantsTest, ASmallAntrumHasLessAirBehindTheIncus) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& plain = ear(seed);
    const BoneModel& small = ear(seed, "small antrum");
    EXPECT_LT(air_within(small, antrum_of(plain), 4.0),
              0.8 * air_within(plain, antrum_of(plain), 4.0))
        << seed;
    EXPECT_GT(air_within(small, antrum_of(plain), 4.0), 20.0) << seed;
  }
}

TEST(EarVariantsTest, ADehiscentNerveIsTouchedByAir) {
  for (const std::uint64_t seed : kSeeds) {
    EXPECT_LE(bare_faces(ear(seed)), 2) << seed;
    EXPECT_GE(bare_faces(ear(seed, "dehiscent facial nerve")), 10) << seed;
  }
}

TEST(EarVariantsTest, AScleroticMastoidHasNoCellsAndIsDense) {
  for (const std::uint64_t seed : kSeeds) {
    const BoneModel& plain = ear(seed);
    const BoneModel& sclerotic = ear(seed, "sclerotic mastoid");
    const Eigen::Vector3d mastoid = antrum_of(plain) + Eigen::Vector3d(-7.0, 2.0, -7.0);
    EXPECT_GT(air_within(plain, mastoid, 5.0), 20.0) << seed;
    EXPECT_LT(air_within(sclerotic, mastoid, 5.0), 6.0) << seed;
    EXPECT_GT(dense_share(sclerotic), 0.99) << seed;
    EXPECT_LT(dense_share(plain), 0.95) << seed;
  }
}

TEST(EarVariantsTest, EveryVariantKeepsEveryStructureAndTheNerveInOnePiece) {
  for (const std::string& variant : ear_variants()) {
    const BoneSummary summary = summary_of(ear(1, variant));
    std::array<std::size_t, 32> pieces{};
    for (const StructureSummary& one : summary.structures) {
      pieces.at(static_cast<std::size_t>(one.label)) = one.pieces;
    }
    for (int label = 1; label <= static_cast<int>(Anatomy::kEarCanal); ++label) {
      EXPECT_GT(pieces.at(static_cast<std::size_t>(label)), 0U) << variant << ", label " << label;
    }
    EXPECT_EQ(pieces.at(static_cast<std::size_t>(Anatomy::kFacialNerve)), 1U) << variant;
    EXPECT_EQ(pieces.at(static_cast<std::size_t>(Anatomy::kIncus)), 1U) << variant;
  }
}

TEST(EarVariantsTest, AnUnknownVariantIsRefusedWithTheNearest) {
  try {
    ear(1, "low tegmn");
    FAIL() << "it is none";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("low tegmen"));
    EXPECT_THAT(error.what(), testing::HasSubstr("sclerotic mastoid"));
  }
}

}  // namespace
}  // namespace haptrial::bone

namespace haptrial::bone::ear_side_test {
namespace {

BoneModel right_ear() { return make_temporal_bone({.seed = 2, .spacing = 1e-3}); }

TEST(EarSideTest, TheMadeEarIsARightOneAndItsMirrorImageALeftOne) {
  const BoneModel right = right_ear();
  const BoneModel left = mirrored(right);
  EXPECT_EQ(ear_side(right), EarSide::kRight);
  EXPECT_EQ(ear_side(left), EarSide::kLeft);
  const auto directions = ear_directions(right);
  ASSERT_TRUE(directions);
  EXPECT_LT(directions->outwards.x(), -0.5);
  EXPECT_GT(directions->back.y(), 0.0);
  EXPECT_GT(outside_view(right).dot(directions->outwards), 0.9);
  EXPECT_GT(outside_view(left).dot(ear_directions(left)->outwards), 0.9);
}

TEST(EarSideTest, AMirrorImageHasEveryVoxelOnTheOtherSideOfThePatient) {
  const BoneModel right = right_ear();
  const BoneModel left = mirrored(right);
  const int last = right.grid.size[0] - 1;
  for (int n = 0; n < 1000; ++n) {
    const int i = 37 * n % (last + 1);
    const int j = 53 * n % right.grid.size[1];
    const int k = 71 * n % right.grid.size[2];
    ASSERT_EQ(left.labels[left.grid.index(last - i, j, k)],
              right.labels[right.grid.index(i, j, k)]);
    const Eigen::Vector3d here = right.grid.centre(i, j, k);
    const Eigen::Vector3d there = left.grid.centre(last - i, j, k);
    ASSERT_LT((there - Eigen::Vector3d(-here.x(), here.y(), here.z())).norm(), 1e-9);
  }
  const BoneModel again = mirrored(left);
  EXPECT_EQ(again.labels, right.labels);
  EXPECT_LT((again.grid.origin - right.grid.origin).norm(), 1e-9);
}

TEST(EarSideTest, WithoutItsStructuresNobodyKnows) {
  BoneModel plain = right_ear();
  for (std::uint8_t& label : plain.labels) {
    label = label == 0 ? 0 : 1;
  }
  EXPECT_FALSE(ear_side(plain));
  EXPECT_FALSE(ear_directions(plain));
}

TEST(AnatomyNamesTest, NamesThatAreNotKnownHaveANearestOne) {
  EXPECT_TRUE(is_known_structure("Facial_Nerve"));
  EXPECT_TRUE(is_known_structure("CN VII"));
  EXPECT_FALSE(is_known_structure("facial nevre"));
  EXPECT_EQ(nearest_structure("facial nevre"), "facial nerve");
  EXPECT_EQ(nearest_structure("left_incus_body"), "incus");
  EXPECT_EQ(nearest_structure("sigmoid sinus left"), "sigmoid sinus and dura");
}

}  // namespace
}  // namespace haptrial::bone::ear_side_test
