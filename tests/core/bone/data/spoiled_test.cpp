// Files with some bytes changed, cut or put in: each gives a bone or a sentence, and no library
// takes the program with it.

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/bone_file.h"
#include "core/bone/data/load_bone.h"
#include "tests/core/bone/data/volume_bytes.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone {
namespace {

std::string spoiled(std::string bytes, RandomStream& random) {
  const std::uint64_t changes = 1 + random.below(6);
  for (std::uint64_t change = 0; change < changes && !bytes.empty(); ++change) {
    // Most of them in the head, where they do more.
    const std::size_t reach =
        random.below(4) == 0 ? bytes.size() : std::min<std::size_t>(400, bytes.size());
    const std::size_t at = random.below(reach);
    switch (random.below(5)) {
      case 0:
        bytes.erase(at, 1 + random.below(20));
        break;
      case 1:
        bytes.insert(at, 1 + random.below(8), static_cast<char>(random.below(256)));
        break;
      case 2:
        bytes[at] = static_cast<char>('0' + random.below(10));
        break;
      case 3:
        bytes.resize(random.below(16) == 0 ? at : bytes.size());
        break;
      default:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
    }
  }
  return bytes;
}

/// How many of the spoiled files were read after all.
int read_spoiled(const std::string& name, const std::string& whole, int count) {
  const test::TemporaryFolder folder;
  RandomStream random(17, name);
  int read = 0;
  for (int i = 0; i < count; ++i) {
    test::write_bytes(folder / name, spoiled(whole, random));
    try {
      check(load_bone(folder / name));
      ++read;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
  return read;
}

int trials() {
  const char* more = std::getenv("HAPTRIAL_SPOILED");  // for a longer search
  return more == nullptr ? 60 : std::atoi(more);
}

test::PlainVolume bar() {
  test::PlainVolume volume({9, 8, 7});
  volume.steps *= 0.5;
  volume.more = "label_01:=Bone\nlabel_02:=Malleus\n";
  return volume.fill([](const Eigen::Vector3d& p) { return p.x() > 2 ? 1 + (p.y() > 2) : 0; });
}

TEST(SpoiledTest, Nrrd) {
  EXPECT_LT(read_spoiled("v.nrrd", nrrd_of(bar()), trials()), trials());
  EXPECT_LT(read_spoiled("z.nrrd", nrrd_of(bar(), false, true), trials()), trials());
}

TEST(SpoiledTest, Nifti) {
  EXPECT_LT(read_spoiled("v.nii", nifti_of(bar(), true, 1002), trials()), trials());
  EXPECT_LT(read_spoiled("v.nii.gz", test::gzip(nifti_of(bar(), true, 1002)), trials()), trials());
}

TEST(SpoiledTest, OurOwn) {
  const test::TemporaryFolder folder;
  BoneModel model;
  model.name = "bar";
  model.grid = {{9, 8, 7}, Eigen::Vector3d::Zero(), 0.5e-3};
  model.structures = known_structures();
  model.labels.assign(model.grid.count(), 1);
  model.density.assign(model.grid.count(), 51.0F / 255.0F);
  save_bone(folder / "b.nrrd", model);
  EXPECT_LT(read_spoiled("b.nrrd", test::read_bytes(folder / "b.nrrd"), trials()), trials());
}

}  // namespace
}  // namespace haptrial::bone
