// haptrial bone import, info and make, as they are called from a shell.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/experiments/command.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BoneCommandTest : public ::testing::Test {
 protected:
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  /// The command refuses with a sentence, status 2 and nothing written.
  void expect_refusal(const std::string& line, const std::string& words) {
    const auto before = files();
    const auto result = run(line);
    EXPECT_EQ(result.status, 2) << line << "\n" << result.output;
    EXPECT_THAT(result.errors, HasSubstr(words)) << line;
    EXPECT_EQ(files(), before) << line;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }
  test::TemporaryFolder folder_;
};

TEST_F(BoneCommandTest, ABoneThatIsMadeSaysWhatItHolds) {
  const auto result = run(
      "haptrial bone make temporal ear.nrrd --seed 3 --spacing 1 && haptrial bone info ear.nrrd");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("right temporal bone, seed 3, 1 mm"),
                                   HasSubstr("facial nerve"), HasSubstr("sigmoid sinus and dura")));
  EXPECT_EQ(run("haptrial bone make mandible jaw.nrrd --spacing 2").status, 0);
}

TEST_F(BoneCommandTest, TheSameSeedGivesTheSameFile) {
  const auto result =
      run("haptrial bone make temporal a.nrrd --seed 4 --spacing 2 && haptrial bone make temporal "
          "b.nrrd --seed 4 --spacing 2 && cmp a.nrrd b.nrrd && haptrial bone make temporal c.nrrd "
          "--seed 5 --spacing 2 && ! cmp -s a.nrrd c.nrrd");
  EXPECT_EQ(result.status, 0) << result.errors;
}

TEST_F(BoneCommandTest, AnImportedBoneCanBeResampledAndPutInPlaceOfItself) {
  ASSERT_EQ(run("haptrial bone make temporal ear.nrrd --spacing 1").status, 0);
  const auto result =
      run("haptrial bone import ear.nrrd out.nrrd --spacing 2 --without 'ear canal,tmj' && "
          "haptrial bone import ear.nrrd out.nrrd --spacing 2 --overwrite");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("voxels of 2 mm"));
}

TEST_F(BoneCommandTest, WhatIsWrongIsRefusedInASentence) {
  ASSERT_EQ(run("haptrial bone make temporal ear.nrrd --spacing 2").status, 0);
  std::ofstream(folder_ / "text.nrrd") << "nothing";
  expect_refusal("haptrial bone info absent.nrrd", "absent.nrrd: no such file or folder");
  expect_refusal("haptrial bone info text.nrrd", "does not begin with 'NRRD000'");
  expect_refusal("haptrial bone make skull new.nrrd", "allowed: temporal, mandible");
  expect_refusal("haptrial bone make temporal new.stl", "ends in '.stl'; allowed: .nrrd");
  expect_refusal("haptrial bone make temporal new.nrrd --spacing 9", "allowed: 0.1 to 2 mm");
  expect_refusal("haptrial bone make temporal ear.nrrd", "exists already");
  expect_refusal("haptrial bone make temporal new.nrrd --seed x", "seed");
  expect_refusal("haptrial bone import ear.nrrd new.nrrd --threshold much", "a number, or auto");
  expect_refusal("haptrial bone import ear.nrrd new.nrrd --as bone", "auto, labels, grey");
  expect_refusal("haptrial bone import ear.nrrd new.nrrd --without tooth", "no 'tooth'");
  expect_refusal("haptrial bone import ear.nrrd new.nrrd --max-memory 1e-9", "--max-memory allows");
}

TEST_F(BoneCommandTest, ACtBecomesABone) {
  const auto file = test::shared_data("ct/headsq_quarter_64x64x93.nrrd");
  if (!file) {
    GTEST_SKIP()
        << "neither HAPTRIAL_DATA nor ../shared/data holds ct/headsq_quarter_64x64x93.nrrd";
  }
  expect_refusal("haptrial bone import " + file->string() + " head.nrrd", "not Hounsfield units");
  const auto result =
      run("haptrial bone import " + file->string() + " head.nrrd --threshold 1324 --spacing 2");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("bone from 1324 on"));
  EXPECT_THAT(result.errors, IsEmpty());
}

}  // namespace
}  // namespace haptrial
