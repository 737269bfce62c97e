#include "core/bone/data/bone_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone {
namespace {

using ::testing::HasSubstr;

BoneModel speckled(bool with_density) {
  RandomStream random(5, "bone file");
  BoneModel model;
  model.name = "speckled";
  model.source = "a test";
  model.grid = {{7, 5, 4}, {0.0123456789, -1.0 / 3.0, 0.1}, 0.29e-3 / 3.0};
  model.structures = known_structures();
  for (std::size_t i = 0; i < model.grid.count(); ++i) {
    const auto label = static_cast<std::uint8_t>(random.below(19));
    model.labels.push_back(label);
    const auto level = static_cast<float>(1 + random.below(255));
    if (with_density) {
      model.density.push_back(label == 0 ? 0.0F : level / 255.0F);
    }
  }
  return model;
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 256> piece{};
  while (std::fgets(piece.data(), piece.size(), pipe.get()) != nullptr) {
    text += piece.data();
  }
  return text;
}

TEST(BoneFileTest, WhatIsSavedIsLoadedToTheLastBit) {
  const test::TemporaryFolder folder;
  for (const bool with_density : {false, true}) {
    const BoneModel model = speckled(with_density);
    save_bone(folder / "b.nrrd", model, true);
    const BoneModel loaded = load_bone(folder / "b.nrrd");
    EXPECT_EQ(loaded.name, model.name);
    EXPECT_EQ(loaded.source, model.source);
    EXPECT_EQ(loaded.labels, model.labels);
    EXPECT_EQ(loaded.density, model.density);
    EXPECT_EQ(loaded.grid.size, model.grid.size);
    EXPECT_EQ(loaded.grid.origin, model.grid.origin);
    EXPECT_EQ(loaded.grid.spacing, model.grid.spacing);
    ASSERT_EQ(loaded.structures.size(), model.structures.size());
    for (std::size_t label = 0; label < model.structures.size(); ++label) {
      EXPECT_EQ(loaded.structures[label].name, model.structures[label].name);
      EXPECT_EQ(loaded.structures[label].colour, model.structures[label].colour);
      EXPECT_EQ(loaded.structures[label].hardness, model.structures[label].hardness);
      EXPECT_EQ(loaded.structures[label].vital, model.structures[label].vital);
    }
  }
}

TEST(BoneFileTest, AnotherProgramReadsTheValues) {
  const test::TemporaryFolder folder;
  const BoneModel model = speckled(true);
  save_bone(folder / "b.nrrd", model);
  const std::string file = "'" + (folder / "b.nrrd").string() + "'";
  const std::string labels =
      output_of("teem-unu slice -a 0 -p 0 -i " + file +
                " | teem-unu save -e raw -f nrrd | teem-unu data - | od -An -v -tu1");
  std::istringstream in(labels);
  for (const std::uint8_t label : model.labels) {
    int read = -1;
    in >> read;
    EXPECT_EQ(read, static_cast<int>(label));
  }
  EXPECT_THAT(output_of("teem-unu head " + file), HasSubstr("label_10:=facial nerve"));
}

TEST(BoneFileTest, DensitiesOfAnyKindAreKeptToAPart) {
  const test::TemporaryFolder folder;
  BoneModel model = speckled(true);
  for (std::size_t i = 0; i < model.density.size(); ++i) {
    if (model.labels[i] != 0) {
      model.density[i] = 1e-7F + 0.99F * static_cast<float>(i) / 140.0F;
    }
  }
  save_bone(folder / "b.nrrd", model);
  const BoneModel loaded = load_bone(folder / "b.nrrd");
  for (std::size_t i = 0; i < model.density.size(); ++i) {
    EXPECT_NEAR(loaded.density[i], model.density[i], 1.01 / 255.0);
    EXPECT_EQ(loaded.density[i] > 0.0F, model.labels[i] != 0);
  }
}

TEST(BoneFileTest, ASavedBoneCanBeResampled) {
  const test::TemporaryFolder folder;
  BoneModel model;
  model.name = "block";
  model.grid = {{12, 12, 12}, {0.0, 0.0, 0.0}, 0.5e-3};
  model.structures = known_structures();
  model.labels.assign(model.grid.count(), 1);
  model.density.assign(model.grid.count(), 102.0F / 255.0F);
  save_bone(folder / "b.nrrd", model);
  LoadOptions options;
  options.spacing = 1e-3;
  const BoneModel coarse = load_bone(folder / "b.nrrd", options);
  EXPECT_EQ(coarse.grid.spacing, 1e-3);
  EXPECT_EQ(coarse.grid.size, (std::array<std::int32_t, 3>{6, 6, 6}));
  for (const float density : coarse.density) {
    EXPECT_FLOAT_EQ(density, 102.0F / 255.0F);
  }
}

TEST(BoneFileTest, NothingIsReplacedAndNoOtherEndingTaken) {
  const test::TemporaryFolder folder;
  const BoneModel model = speckled(false);
  save_bone(folder / "b.nrrd", model);
  EXPECT_THROW(save_bone(folder / "b.nrrd", model), InputError);
  EXPECT_THROW(save_bone(folder / "b.nii", model), InputError);
  BoneModel wrong = model;
  wrong.labels.pop_back();
  EXPECT_THROW(save_bone(folder / "c.nrrd", wrong), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::bone
