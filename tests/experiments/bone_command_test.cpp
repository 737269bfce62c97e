// haptrial bone import, info, make, structures, place and export, as they are called from a shell.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "core/bone/data/anatomy.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::bone_command_test {
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

TEST_F(BoneCommandTest, AScanGetsTheLabelsOfAnotherEar) {
  ASSERT_EQ(run("haptrial bone make temporal known.nrrd --seed 3 --spacing 2").status, 0);
  ASSERT_EQ(run("haptrial bone make temporal true.nrrd --seed 2 --spacing 2").status, 0);
  ASSERT_EQ(run("haptrial bone import true.nrrd scan.nrrd --without 'facial nerve,incus'").status,
            0);
  const auto result =
      run("haptrial bone atlas scan.nrrd ear.nrrd --side right --iterations 10 --against true.nrrd "
          "--ears known.nrrd && haptrial bone info ear.nrrd");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("known.nrrd: correlation 0."), HasSubstr("one ear says nothing"),
                    HasSubstr("labels of 1 registered ear"), HasSubstr("facial nerve")));
  expect_refusal("haptrial bone atlas scan.nrrd new.nrrd --side right --ears known.nrrd known.nrrd",
                 "known.nrrd: is the same ear as known.nrrd; give each ear once");
  expect_refusal("haptrial bone atlas scan.nrrd new.nrrd --side up --ears known.nrrd",
                 "--side is 'up'; allowed: right, left");
  expect_refusal("haptrial bone atlas scan.nrrd new.nrrd --side left --ears absent.nrrd",
                 "absent.nrrd: no such file or folder");
  expect_refusal("haptrial bone atlas scan.nrrd ear.nrrd --side left --ears known.nrrd",
                 "ear.nrrd");
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

TEST_F(BoneCommandTest, TheOptionsOfAnImportAreCheckedBeforeAnythingIsRead) {
  const std::string import = "haptrial bone import absent.nrrd new.nrrd ";
  expect_refusal(import + "--crop 0,1,0,1", "--crop is not a box; allowed: X0,X1,Y0,Y1,Z0,Z1");
  expect_refusal(import + "--crop 1,0,0,1,0,1", "the lower first");
  expect_refusal(import + "--around 1,2,3,0", "allowed: X,Y,Z,EDGE");
  expect_refusal(import + "--around 1,2,3,4 --crop 0,1,0,1,0,1", "write one of them");
  expect_refusal(import + "--structure nerve.stl", "allowed: NAME=FILE");
  expect_refusal(import + "--mesh-axes xyz", "auto, lps, ras");
  expect_refusal(import + "--histogram picture.jpg", "allowed: .png, .svg");
  expect_refusal(import + "--fill 0", "--fill is 0");
}

TEST_F(BoneCommandTest, StructuresAreListedAndNamedByATable) {
  ASSERT_EQ(run("haptrial bone make temporal ear.nrrd --spacing 2").status, 0);
  test::write_text(folder_ / "odd.toml", "[names]\n\"incus\" = \"Incus \\\"dexter\\\"\"\n");
  const auto odd =
      run("haptrial bone structures ear.nrrd --labels odd.toml --out odd.nrrd --table back.toml");
  EXPECT_EQ(odd.status, 0) << odd.errors;
  EXPECT_THAT(odd.output, HasSubstr("unknown; the nearest known name is 'incus'"));
  EXPECT_THAT(odd.output, HasSubstr("known, vital"));
  EXPECT_THAT(test::read_text(folder_ / "back.toml"),
              HasSubstr("\"Incus \\\"dexter\\\"\" = \"incus\"\n"));
  const auto back =
      run("haptrial bone structures odd.nrrd --labels back.toml --out back.nrrd && haptrial bone "
          "structures ear.nrrd > one && haptrial bone structures back.nrrd > two && cmp one two");
  EXPECT_EQ(back.status, 0) << back.errors << back.output;
  expect_refusal("haptrial bone structures ear.nrrd --out odd.nrrd", "exists already");
}

TEST_F(BoneCommandTest, TheLabelsOfADrilledBoneSayWhatTheSessionRemoved) {
  test::write_small_drilling(folder_.path(), 4.0);
  const auto drilled =
      run("haptrial dry-run study.toml --out out >/dev/null && "
          "haptrial bone export out/S01.h5 drilled.seg.nrrd && "
          "haptrial bone export out/S01.h5 drilled.stl && haptrial mesh info drilled.stl");
  ASSERT_EQ(drilled.status, 0) << drilled.errors << drilled.output;
  EXPECT_THAT(drilled.output, HasSubstr("removed     bone: "));
  // The file is read as by another program: a head of text, an empty line, bytes in gzip.
  const auto counts = run(
      "export LC_ALL=C; sed '1,/^$/d' drilled.seg.nrrd | gzip -dc | od -An -v -tu1 -w1 | sort -n | "
      "uniq -c; grep -a -A4 'Segment2_ID' drilled.seg.nrrd; grep -a '^sizes' drilled.seg.nrrd");
  EXPECT_THAT(counts.output, AllOf(HasSubstr("Segment2_LabelValue:=3"),
                                   HasSubstr("Segment2_Name:=removed"), HasSubstr("32 12 20")));
  std::istringstream lines(counts.output);
  std::size_t removed = 0;
  std::size_t all = 0;
  for (std::size_t count = 0, label = 0; lines >> count >> label;) {
    all += count;
    removed += label == 3 ? count : 0;
  }
  EXPECT_EQ(all, 32U * 12U * 20U);
  const record::SessionReader session(folder_ / "out/S01.h5");
  EXPECT_GT(removed, 20U);
  EXPECT_GE(removed, session.rows<record::RemovalRow>().size());
  EXPECT_LE(removed, session.rows<record::RemovalRow>().size() + 64);  // crumbs
  expect_refusal("haptrial bone export out/S01.h5 two.stl --trial 2", "--trial is 2; allowed: 1");
  expect_refusal("haptrial bone export out/S01.h5 one.png", ".stl");
  expect_refusal("haptrial bone export slabs.nrrd a.stl --trial 1", "leave it out for a bone");
  expect_refusal("haptrial bone export slabs.nrrd a.stl --structure nerv", "facial nerve");
  expect_refusal("haptrial bone export slabs.nrrd drilled.stl", "exists already");
}

TEST_F(BoneCommandTest, AStructureLeavesInEveryFormatAndComesBackInItsPlace) {
  ASSERT_EQ(run("haptrial bone make temporal ear.nrrd --spacing 1 && haptrial bone import ear.nrrd "
                "bare.nrrd --without 'sigmoid sinus'")
                .status,
            0);
  const bone::BoneModel ear = bone::load_bone(folder_ / "ear.nrrd");
  const auto sinus = static_cast<std::uint8_t>(bone::Anatomy::kSinusAndDura);
  for (const char* name : {"a.stl", "a.obj", "a.ply", "ras.stl"}) {
    const std::string file = name;
    const bool ras = file == "ras.stl";
    const auto there_and_back = run("haptrial bone export ear.nrrd " + file +
                                    " --structure 'sigmoid sinus'" + (ras ? " --ras" : "") +
                                    " && haptrial bone import bare.nrrd back.nrrd --overwrite "
                                    "--structure 'dura=" +
                                    file + "'" + (ras ? " --mesh-axes ras" : ""));
    ASSERT_EQ(there_and_back.status, 0) << there_and_back.errors;
    const bone::BoneModel back = bone::load_bone(folder_ / "back.nrrd");
    ASSERT_EQ(back.labels.size(), ear.labels.size());
    std::size_t all = 0;
    std::size_t other = 0;
    for (std::size_t at = 0; at < ear.labels.size(); ++at) {
      const bool before = ear.labels[at] == sinus;
      const bool after = back.structures[back.labels[at]].name == "sigmoid sinus and dura";
      all += before ? 1 : 0;
      other += before != after ? 1 : 0;
    }
    EXPECT_GT(all, 500U);
    EXPECT_LT(other, all / 20) << name;  // the surface is smooth
  }
}

TEST_F(BoneCommandTest, ThePictureOfAPlacedBoneIsDrawnAndWhatItCannotBeIsRefused) {
  test::write_small_drilling(folder_.path(), 1.0);
  const auto placed = run("haptrial bone place study.toml placed.png");
  EXPECT_EQ(placed.status, 0) << placed.errors;
  EXPECT_THAT(placed.output, AllOf(HasSubstr("no side is known"), HasSubstr("wrote")));
  EXPECT_GT(std::filesystem::file_size(folder_ / "placed.png"), 10'000U);
  expect_refusal("haptrial bone place study.toml placed.png", "exists already");
  expect_refusal("haptrial bone place study.toml placed.jpg", "allowed: .png");
  expect_refusal("haptrial bone place study.toml two.png --bone 2",
                 "--bone is 2; allowed: a whole");
}

}  // namespace

// haptrial bone fit-feel as a stranger uses it.

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// An exact trace of a ball of 3 mm radius: gains of 0.5 and 1.5 N/mm^3 with 2 mm^3 between them.
std::string exact_trace() {
  std::string text = "time,depth,force\n";
  for (int n = 1; n <= 60; ++n) {
    const double h = 2e-5 * n;
    const double volume = std::numbers::pi * h * h * (3e-3 - h / 3.0);
    const double force = 0.5e9 * std::min(volume, 2e-9) + 1.5e9 * std::max(0.0, volume - 2e-9);
    text += fmt::format("{},{:.9g},{:.9g}\n", 1e-3 * n, h, force);
  }
  return text;
}

TEST(FitFeelCommandTest, AnExactTraceGivesItsConstantsAsKeysOfADefinition) {
  const test::TemporaryFolder folder;
  const fs::path study = test::write_small_drilling(folder.path(), 1.0);
  test::write_text(folder / "press.csv", exact_trace());
  const std::string command = "haptrial bone fit-feel '" + (folder / "press.csv").string() +
                              "' --definition '" + study.string() + "' ";
  const fs::path out = folder / "fitted.toml";
  const auto done = test::run_command(command + "--tool cutting --out '" + out.string() + "'");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("60 samples in contact"));
  EXPECT_THAT(done.output, HasSubstr("removal        not fitted"));
  const auto fitted = protocols::load_bone_definition(out);
  const auto& feel = fitted.simulator.tools[0].as<bone::BurrTool>()->feel;
  EXPECT_NEAR(feel.first_gain, 0.5e9, 1e4);
  EXPECT_NEAR(feel.second_gain, 1.5e9, 1e4);
  EXPECT_NEAR(feel.threshold, 2e-9, 1e-13);

  const auto again = test::run_command(command + "--tool cutting --out '" + out.string() + "'");
  EXPECT_EQ(again.status, 2) << "the file is there";
  const auto other = test::run_command(command + "--tool suction");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("allowed: cutting, diamond"));
}

}  // namespace
}  // namespace haptrial::experiments::bone_command_test
