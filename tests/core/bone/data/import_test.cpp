// Voxels of a file come out at the right place; wrong statements of a file are refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/bone/data/bone_file.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone {
namespace {

using test::PlainVolume;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ImportTest : public ::testing::Test {
 protected:
  BoneModel load(const std::string& name, const std::string& bytes,
                 const LoadOptions& options = {}) {
    test::write_bytes(folder_ / name, bytes);
    return load_bone(folder_ / name, options);
  }
  std::string refusal(const std::string& name, const std::string& bytes,
                      const LoadOptions& options = {}) {
    try {
      load(name, bytes, options);
    } catch (const InputError& error) {
      const std::string words = error.what();
      EXPECT_EQ(std::ranges::count(words, '\n'), 0) << words;
      return words;
    }
    return "none";
  }
  test::TemporaryFolder folder_;
};

/// The place of the only voxel with a label [mm].
Eigen::Vector3d place_of(const BoneModel& model, std::uint8_t label) {
  Eigen::Vector3d place = Eigen::Vector3d::Constant(1e9);
  int count = 0;
  geometry::visit_voxels(model.grid, [&](const Eigen::Vector3i& voxel, std::size_t at) {
    if (model.labels[at] != label) {
      return;
    }
    place = 1e3 * model.grid.centre(voxel);
    ++count;
  });
  EXPECT_EQ(count, 1);
  return place;
}

/// Every way to lay a file's axes along the patient's.
std::vector<Eigen::Matrix3d> signed_permutations() {
  std::vector<Eigen::Matrix3d> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d steps = Eigen::Matrix3d::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        steps(order[static_cast<std::size_t>(axis)], axis) = (signs >> axis) % 2 == 0 ? 0.4 : -0.4;
      }
      all.push_back(steps);
    }
  } while (std::ranges::next_permutation(order).found);
  return all;
}

TEST_F(ImportTest, APlaceStaysWhereItIsHoweverTheFileLaysItsAxes) {
  for (const Eigen::Matrix3d& steps : signed_permutations()) {
    PlainVolume volume({4, 5, 6});
    volume.steps = steps;
    volume.origin = {-3.0, 7.0, 11.0};
    volume.more = "label_07:=Facial_Nerve\n";
    volume.at(1, 3, 2) = 7;
    for (const bool ras : {false, true}) {
      const BoneModel model = load("v.nrrd", nrrd_of(volume, ras));
      EXPECT_LT((place_of(model, 7) - volume.place(1, 3, 2)).norm(), 1e-9) << steps;
    }
    const BoneModel nifti = load("v.nii", nifti_of(volume, true, 1002));
    EXPECT_LT((place_of(nifti, 7) - volume.place(1, 3, 2)).norm(), 1e-5) << steps;
  }
}

TEST_F(ImportTest, CompressedVolumesAreTheSame) {
  PlainVolume volume({4, 5, 6});
  volume.more = "label_01:=Bone\n";
  volume.fill([](const Eigen::Vector3d& p) { return p.sum() > 7.0 ? 1 : 0; });
  const BoneModel plain = load("p.nrrd", nrrd_of(volume));
  EXPECT_EQ(load("z.nrrd", nrrd_of(volume, false, true)).labels, plain.labels);
  // Without a word on orientation NIfTI counts to the right, to the front and up.
  PlainVolume ras = volume;
  ras.steps = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  const std::string bare = nifti_of(ras, false);
  EXPECT_EQ(load("z.nii.gz", test::gzip(bare)).labels, load("p.nii", nifti_of(ras)).labels);
}

TEST_F(ImportTest, NamesBringWhatIsKnownOfThem) {
  PlainVolume volume({2, 2, 2});
  volume.more = "label_03:=Chorda_Tympani\nlabel_04:=Thing of its own\n";
  volume.at(0, 0, 0) = 3;
  volume.at(1, 0, 0) = 4;
  const BoneModel model = load("v.nrrd", nrrd_of(volume));
  EXPECT_EQ(model.structures[3].name, "chorda tympani");
  EXPECT_TRUE(model.structures[3].vital);
  EXPECT_EQ(model.structures[4].name, "Thing of its own");
  EXPECT_FALSE(model.structures[4].vital);
}

// "Sigmoid sinus" and "dura" are forms of one known name: no user of a name may meet a part of it.
TEST_F(ImportTest, LabelsOfOneNameBecomeOneStructure) {
  PlainVolume volume({4, 4, 4});
  volume.more =
      "label_01:=bone\nlabel_05:=sigmoid sinus\nlabel_06:=own\nlabel_08:=own\n"
      "label_09:=Dura\n";
  volume.fill([](const Eigen::Vector3d&) { return 1; });
  volume.at(0, 0, 0) = 5;
  volume.at(3, 3, 3) = volume.at(3, 3, 2) = 9;
  volume.at(1, 0, 0) = 6;
  volume.at(2, 0, 0) = 8;
  const BoneModel model = load("v.nrrd", nrrd_of(volume));
  EXPECT_EQ(std::ranges::count(model.labels, 5), 3);
  EXPECT_EQ(std::ranges::count(model.labels, 6), 2);
  EXPECT_EQ(std::ranges::count(model.structures, "sigmoid sinus and dura", &Structure::name), 1);
  EXPECT_EQ(std::ranges::count(model.structures, "own", &Structure::name), 1);
  EXPECT_THAT(model.notes,
              ElementsAre("labels 6 and 8 are one structure here, own",
                          "labels 5 and 9 are one structure here, sigmoid sinus and dura"));
  LoadOptions without;
  without.without = {"sigmoid sinus"};
  const BoneModel rest = load("v.nrrd", nrrd_of(volume), without);
  EXPECT_EQ(std::ranges::count(rest.labels, 0), 3);
}

/// A ball of labels [mm].
PlainVolume ball(const Eigen::Matrix3d& steps, std::array<int, 3> size, double radius) {
  PlainVolume volume(size);
  volume.steps = steps;
  const Eigen::Vector3d half(size[0] - 1, size[1] - 1, size[2] - 1);
  volume.origin = Eigen::Vector3d(5, 6, 7) - steps * half / 2.0;
  return volume.fill([&](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(5, 6, 7)).norm() < radius ? 1 : 0;
  });
}

TEST_F(ImportTest, ASmallTurnIsKeptAndALargeOneResampled) {
  const auto turned = [](double degrees) {
    const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180.0,
                                 Eigen::Vector3d(1, 2, 3).normalized());
    return ball(0.5 * turn.toRotationMatrix(), {40, 40, 40}, 7.0);
  };
  const PlainVolume little = turned(0.9);
  const BoneModel kept = load("a.nrrd", nrrd_of(little));
  EXPECT_TRUE(std::ranges::equal(kept.labels, little.values));
  EXPECT_THAT(kept.source, HasSubstr("turned by 0.90 degrees, whose axes are kept"));
  // 2 sin(0.45°) of the farthest distance of two corners from an axis along (1, 2, 3)
  ASSERT_EQ(kept.notes.size(), 1U);
  EXPECT_THAT(kept.notes[0], HasSubstr("lies up to 0.53 mm beside the scan"));
  for (const double degrees : {1.1, 20.0, 44.0, 70.0}) {
    const BoneSummary summary = summary_of(load("b.nrrd", nrrd_of(turned(degrees))));
    const double exact = 4.0 / 3.0 * std::numbers::pi * 343.0;
    EXPECT_NEAR(1e9 * summary.volume, exact, 0.02 * exact) << degrees;
    EXPECT_LT((1e3 * summary.box.center() - Eigen::Vector3d(5, 6, 7)).norm(), 0.5) << degrees;
    EXPECT_LT((1e3 * summary.box.sizes() - Eigen::Vector3d::Constant(14)).norm(), 1.2) << degrees;
  }
}

TEST_F(ImportTest, LabelsOfFlatVoxelsKeepTheirVolumeAndMixNothing) {
  const Eigen::Matrix3d steps = Eigen::Vector3d(0.4, 0.5, 1.3).asDiagonal();
  PlainVolume volume = ball(steps, {60, 50, 20}, 8.0);
  for (std::int16_t& value : volume.values) {
    value = static_cast<std::int16_t>(9 * value);
  }
  const BoneModel model = load("v.nrrd", nrrd_of(volume));
  EXPECT_DOUBLE_EQ(model.grid.spacing, 0.4e-3);
  const BoneSummary summary = summary_of(model);
  ASSERT_EQ(summary.structures.size(), 1U);
  EXPECT_EQ(summary.structures[0].label, 9);
  const double exact = 4.0 / 3.0 * std::numbers::pi * 512.0;
  EXPECT_NEAR(1e9 * summary.volume, exact, 0.02 * exact);
}

TEST_F(ImportTest, ABallOfGreyKeepsItsVolumeAtAnySpacing) {
  // An edge 2 mm wide around 8 mm, so that every scan can hold it; the middle value is the edge.
  const Eigen::Matrix3d steps = Eigen::Vector3d(0.8, 0.8, 1.6).asDiagonal();
  PlainVolume volume = ball(steps, {36, 36, 18}, 8.0);
  volume.fill([](const Eigen::Vector3d& p) {
    const double r = (p - Eigen::Vector3d(5, 6, 7)).norm();
    return -1000.0 + 2600.0 * std::clamp(0.5 - (r - 8.0) / 3.0, 0.0, 1.0);
  });
  LoadOptions options;
  const double exact = 4.0 / 3.0 * std::numbers::pi * 512.0;
  for (const double spacing : {0.4, 0.5, 0.8, 1.2}) {
    options.spacing = 1e-3 * spacing;
    const BoneModel model = load("v.nrrd", nrrd_of(volume), options);
    const BoneSummary summary = summary_of(model);
    EXPECT_DOUBLE_EQ(model.grid.spacing, 1e-3 * spacing);
    EXPECT_NEAR(1e9 * summary.volume, exact, 0.03 * exact) << spacing;
    EXPECT_LT((1e3 * summary.box.center() - Eigen::Vector3d(5, 6, 7)).norm(), spacing);
    EXPECT_NEAR(1e6 * summary.surface, 4.0 * std::numbers::pi * 64.0, 40.0);
    EXPECT_FLOAT_EQ(*std::ranges::max_element(model.density), 1.0F);
  }
}

TEST_F(ImportTest, NumbersThatAreNotHounsfieldUnitsNeedAThreshold) {
  PlainVolume volume({20, 20, 20});
  volume.fill([](const Eigen::Vector3d& p) {
    return p.x() < 8 ? 10.0 + p.y() : p.x() < 14 ? 1000.0 + p.y() : 2000.0 + p.y();
  });
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume)),
              AllOf(HasSubstr("from 10 to 2019"), HasSubstr("not Hounsfield units")));
  LoadOptions options;
  options.find_threshold = true;
  options.spacing = 1e-3;
  const BoneModel found = load("v.nrrd", nrrd_of(volume), options);
  EXPECT_EQ(summary_of(found).voxels, 6U * 20U * 20U);
  options.find_threshold = false;
  options.threshold = 500.0;
  EXPECT_EQ(summary_of(load("v.nrrd", nrrd_of(volume), options)).voxels, 12U * 20U * 20U);
}

TEST_F(ImportTest, AThresholdBelowBoneIsNotFound) {
  PlainVolume volume({20, 20, 20});
  volume.fill([](const Eigen::Vector3d& p) {
    return p.head<2>().norm() > 18.0 ? -2000.0 : p.x() < 8 ? -1000.0 + p.y() : 20.0 + p.z();
  });
  LoadOptions options;
  options.find_threshold = true;
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume), options), HasSubstr("where there is no bone"));
}

TEST_F(ImportTest, UnitsAreKnownOrRefused) {
  PlainVolume volume({20, 20, 20});
  volume.steps *= 20.0;
  volume.at(3, 4, 5) = 1;
  for (const char* unit : {"um", "micrometer", "micron", "microns", "\u00b5m", "\u03bcm"}) {
    volume.more = fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\nlabel_01:=Bone\n", unit);
    const Eigen::Vector3d place = place_of(load("v.nrrd", nrrd_of(volume)), 1);
    EXPECT_LT((place - Eigen::Vector3d(0.06, 0.08, 0.1)).norm(), 1e-6) << unit;
  }
  volume.steps = Eigen::Matrix3d::Identity();
  volume.more = "space units: \"in\" \"in\" \"in\"\nlabel_01:=Bone\n";
  EXPECT_LT((place_of(load("v.nrrd", nrrd_of(volume)), 1) - 25.4 * Eigen::Vector3d(3, 4, 5)).norm(),
            1e-6);
  volume.more = "space units: \"ells\" \"ells\" \"ells\"\n";
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume)), HasSubstr("its unit of length is 'ells'"));
  std::string nifti = nifti_of(volume);
  nifti[123] = 5;
  EXPECT_THAT(refusal("v.nii", nifti), HasSubstr("its unit of length is code 5"));
}

TEST_F(ImportTest, FewWholeNumbersAreLabelsAndManyAreGrey) {
  PlainVolume labels({8, 8, 8});
  labels.fill([](const Eigen::Vector3d& p) { return p.x() > 3 ? 3 : 0; });
  EXPECT_EQ(load("l.nrrd", nrrd_of(labels)).labels.back(), 3);
  PlainVolume grey({8, 8, 8});
  int next = 0;
  for (std::int16_t& value : grey.values) {
    value = static_cast<std::int16_t>(next++ % 256);
  }
  EXPECT_THAT(refusal("g.nrrd", nrrd_of(grey)), HasSubstr("not Hounsfield units"));
}

TEST_F(ImportTest, WhatCannotBeABoneIsRefusedInASentence) {
  PlainVolume volume({4, 4, 4});
  volume.more = "label_01:=Bone\n";
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume)), HasSubstr("holds no bone"));
  volume.at(1, 1, 1) = 300;
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume)), HasSubstr("whole numbers from 0 to 255"));
  volume.at(1, 1, 1) = 1;
  const std::string good = nrrd_of(volume);
  // Sentences are in our own words, and not in those of a library's functions.
  EXPECT_THAT(refusal("v.nrrd", good.substr(0, good.size() - 5)),
              HasSubstr("v.nrrd: its values are damaged or incomplete"));
  EXPECT_THAT(refusal("v.nrrd", good.substr(0, 40)),
              HasSubstr("v.nrrd: its header is damaged or lacks a field"));
  EXPECT_THAT(refusal("v.nrrd", ""), HasSubstr("does not begin with 'NRRD000'"));
  EXPECT_THAT(refusal("v.mha", good), HasSubstr("not a volume by its name"));
  std::string zipped = nrrd_of(volume, false, true);
  for (std::size_t i = zipped.size() - 20; i < zipped.size() - 8; ++i) {
    zipped[i] ^= 0x55;
  }
  EXPECT_THAT(refusal("v.nrrd", zipped), HasSubstr("v.nrrd"));
  EXPECT_THAT(refusal("v.nii", nifti_of(volume).substr(0, 300)), HasSubstr("NIfTI"));
  EXPECT_THAT(refusal("v.nii", nifti_of(volume).substr(0, 400)), HasSubstr("v.nii"));
  PlainVolume flat = volume;
  flat.steps.col(2) = flat.steps.col(1);
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(flat)), HasSubstr("span a volume"));
  PlainVolume air({4, 4, 4});
  air.fill([](const Eigen::Vector3d& p) { return -1000.0 + p.x(); });
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(air)), HasSubstr("all below the threshold of 300"));
  EXPECT_THROW(load_bone(folder_ / "absent.nrrd"), InputError);
}

TEST_F(ImportTest, AVolumeWithoutAFiniteValueIsRefused) {
  std::string bytes = nrrd_of(PlainVolume({2, 2, 2}));
  bytes.replace(bytes.find("int16"), 5, "float");
  bytes.resize(bytes.size() - 8 * sizeof(std::int16_t));
  for (const float none : {NAN, INFINITY, -INFINITY, NAN, NAN, NAN, NAN, NAN}) {
    bytes.append(reinterpret_cast<const char*>(&none), sizeof none);
  }
  EXPECT_THAT(refusal("v.nrrd", bytes), HasSubstr("none of its values is a finite number"));
}

TEST_F(ImportTest, ValuesThatAreNoNumbersAreCounted) {
  PlainVolume volume({4, 4, 4});
  std::string bytes = nrrd_of(volume);
  bytes.replace(bytes.find("int16"), 5, "float");
  bytes.resize(bytes.size() - 64 * sizeof(std::int16_t));
  for (int i = 0; i < 64; ++i) {
    const float value = i % 4 == 0 ? NAN : i < 32 ? -1000.0F : 1200.0F;
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const BoneModel nrrd = load("v.nrrd", bytes);
  EXPECT_THAT(nrrd.notes, ElementsAre(HasSubstr("16 of the 64 values of")));
  for (const bool wide : {false, true}) {  // the same body as NIfTI of 32 and of 64 bits
    std::string nifti = nifti_of(volume);
    nifti[70] = wide ? 64 : 16;
    nifti[72] = wide ? 64 : 32;
    nifti.resize(352);
    for (int i = 0; i < 64; ++i) {
      const float value = i % 4 == 0 ? NAN : i < 32 ? -1000.0F : 1200.0F;
      const auto twice = static_cast<double>(value);
      nifti.append(
          wide ? reinterpret_cast<const char*>(&twice) : reinterpret_cast<const char*>(&value),
          wide ? sizeof twice : sizeof value);
    }
    const BoneModel model = load("v.nii", nifti);
    EXPECT_THAT(model.notes, ElementsAre(HasSubstr("16 of the 64 values of")));
    EXPECT_EQ(model.labels, nrrd.labels);
  }
}

// A nerve of one voxel in a block of bone is lost in voxels of four, and the bone is not.
TEST_F(ImportTest, StructuresLostInCoarseVoxelsAreSaidAndKeptWithTheBone) {
  PlainVolume volume({16, 16, 16});
  volume.more = "label_01:=Bone\nlabel_07:=Facial_Nerve\n";
  volume.fill([](const Eigen::Vector3d&) { return 1; });
  for (int k = 0; k < 16; ++k) {
    volume.at(8, 8, k) = 7;
  }
  EXPECT_THAT(load("v.nrrd", nrrd_of(volume)).notes, IsEmpty());
  LoadOptions coarse;
  coarse.spacing = 4e-3;
  const BoneModel model = load("v.nrrd", nrrd_of(volume), coarse);
  const std::string note = "facial nerve, a vital structure, is lost: 16.0 mm3 in " +
                           (folder_ / "v.nrrd").string() + ", none here";
  EXPECT_THAT(model.notes, ElementsAre(note));
  save_bone(folder_ / "b.nrrd", model);
  EXPECT_THAT(load_bone(folder_ / "b.nrrd").notes, ElementsAre(note));
}

TEST_F(ImportTest, AnOrientationThatAFileDoesNotSayIsSaid) {
  PlainVolume volume({4, 4, 4});
  volume.at(1, 2, 3) = 1;
  std::string bytes = nrrd_of(volume);
  EXPECT_THAT(load("v.nrrd", bytes).notes, IsEmpty());
  const std::string space = "space: left-posterior-superior";
  bytes.replace(bytes.find(space), space.size(), "space dimension: 3");
  EXPECT_THAT(load("v.nrrd", bytes).notes,
              ElementsAre(HasSubstr("left-posterior-superior is assumed")));
  std::string nifti = nifti_of(volume);
  EXPECT_THAT(load("v.nii", nifti).notes, IsEmpty());
  EXPECT_THAT(load("v.nii", nifti_of(volume, false)).notes,
              ElementsAre(HasSubstr("right-anterior-superior is assumed")));
}

TEST_F(ImportTest, AVolumeWithoutAUnitIsInMillimetresAndSaysSo) {
  PlainVolume volume({4, 4, 4});
  volume.at(1, 2, 3) = 1;
  const std::string sentence = "without a unit of length, so in mm";
  EXPECT_THAT(load("v.nrrd", nrrd_of(volume)).source, HasSubstr(sentence));
  EXPECT_THAT(load("v.nii", nifti_of(volume)).source, Not(HasSubstr(sentence)));
  std::string nifti = nifti_of(volume);
  nifti[123] = 0;
  EXPECT_THAT(load("v.nii", nifti).source, HasSubstr(sentence));
  volume.more = "space units: \"mm\" \"mm\" \"mm\"\n";
  EXPECT_THAT(load("v.nrrd", nrrd_of(volume)).source, Not(HasSubstr(sentence)));
}

TEST_F(ImportTest, AHeadThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
  PlainVolume volume({4, 4, 4});
  volume.at(0, 0, 0) = 1;
  std::string lie = nrrd_of(volume);
  const std::string sizes = "sizes: 4 4 4";
  lie.replace(lie.find(sizes), sizes.size(), "sizes: 30000 30000 30000");
  EXPECT_THAT(refusal("v.nrrd", lie), AllOf(HasSubstr("30000"), HasSubstr("GB of memory")));
  lie.replace(lie.find("30000 30000"), 11, "99999 30000");
  EXPECT_THAT(refusal("v.nrrd", lie), HasSubstr("1 to 32767 along an axis"));
  LoadOptions options;
  options.room = [](const std::string& what, double bytes) {
    throw InputError(fmt::format("{} needs {} bytes", what, bytes));
  };
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume), options), HasSubstr("needs 1280 bytes"));
}

TEST_F(ImportTest, ATableNamesLabelsAndStructuresCanBeLeftOut) {
  PlainVolume volume({4, 4, 4});
  volume.at(0, 0, 0) = 1;
  volume.at(3, 3, 3) = 12;
  test::write_bytes(folder_ / "names.toml",
                    "[labels.1]\nname = \"mandible\"\n[labels.12]\nname = \"IAN\"\n"
                    "colour = [0.1, 0.2, 0.3]\nhardness = 0.5\nvital = false\n");
  LoadOptions options;
  options.label_file = (folder_ / "names.toml").string();
  const BoneModel model = load("v.nrrd", nrrd_of(volume), options);
  EXPECT_EQ(model.structures[1].name, "mandible");
  EXPECT_EQ(model.structures[12].name, "inferior alveolar nerve");
  EXPECT_DOUBLE_EQ(model.structures[12].colour[2], 0.3);
  EXPECT_DOUBLE_EQ(model.structures[12].hardness, 0.5);
  EXPECT_FALSE(model.structures[12].vital);
  options.without = {"ian"};
  EXPECT_EQ(summary_of(load("v.nrrd", nrrd_of(volume), options)).voxels, 1U);
  options.without = {"tooth"};
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume), options), HasSubstr("no 'tooth' to leave out"));
  test::write_bytes(folder_ / "names.toml", "[labels.300]\nname = \"x\"\n");
  EXPECT_THAT(refusal("v.nrrd", nrrd_of(volume), options), HasSubstr("labels.300"));
}

TEST_F(ImportTest, ATableMapsNamesThatAreNotKnown) {
  PlainVolume volume({4, 4, 4});
  volume.at(1, 1, 1) = 2;
  volume.more = "label_02:=N. facialis dexter\n";
  EXPECT_FALSE(has_vital_structures(load("v.nrrd", nrrd_of(volume))));
  test::write_bytes(folder_ / "names.toml", "[names]\n\"N. facialis dexter\" = \"CN VII\"\n");
  LoadOptions options;
  options.label_file = (folder_ / "names.toml").string();
  const BoneModel model = load("v.nrrd", nrrd_of(volume), options);
  EXPECT_EQ(model.structures[2].name, "facial nerve");
  EXPECT_TRUE(has_vital_structures(model));
}

TEST_F(ImportTest, TheRealTemporalBonesAreRightEarsAndTheirMirrorImagesLeftOnes) {
  const auto file = test::shared_data("bone/ear3_171_labels.nrrd");
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds bone/ear3_171_labels.nrrd";
  }
  LoadOptions options;
  options.spacing = 1e-3;
  EXPECT_EQ(ear_side(load_bone(*file, options)), EarSide::kRight);
  options.mirror = true;
  EXPECT_EQ(ear_side(load_bone(*file, options)), EarSide::kLeft);
}

TEST_F(ImportTest, TheRealTemporalBoneComesAsItIs) {
  const auto file = test::shared_data("bone/ear3_171_labels.nrrd");
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds bone/ear3_171_labels.nrrd";
  }
  const BoneModel model = load_bone(*file);
  EXPECT_EQ(model.grid.size, (std::array<std::int32_t, 3>{171, 171, 169}));
  EXPECT_EQ(std::ranges::count(model.labels, 1), 825395);  // as its publishers count
  EXPECT_EQ(model.structures[10].name, "facial nerve");
  EXPECT_EQ(model.structures[13].name, "sigmoid sinus and dura");
  EXPECT_TRUE(model.density.empty());
}

}  // namespace
}  // namespace haptrial::bone
