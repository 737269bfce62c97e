// `haptrial recover` as who has lost a file meets it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/record/read/session_reader.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::AllOf;
using testing::HasSubstr;

class RecoverCommandTest : public testing::Test {
 protected:
  RecoverCommandTest() {
    const CommandResult result =
        run_command("haptrial dry-run '" + test::shipped_definition().string() +
                    "' --subjects 1 --trials 3 --out '" + (folder_ / "study").string() + "'");
    if (result.status != 0) {
      throw std::runtime_error(result.errors);
    }
    fs::copy(folder_ / "study/S01.h5", file_);
  }
  /// haptrial COMMAND FILE [OUT]
  CommandResult haptrial(const std::string& command, const fs::path& file,
                         const std::string& out = "") const {
    const std::string last = out.empty() ? "" : fmt::format("'{}'", out);
    return run_command(fmt::format("haptrial {} '{}' {}", command, file.string(), last));
  }
  fs::path in_new_folder(const std::string& name, const fs::path& file) const {
    fs::create_directory(folder_ / name);
    fs::copy(file, folder_ / name / "S01.h5");
    return folder_ / name;
  }
  std::size_t lines_in(const fs::path& file) const {
    const std::string text = test::read_text(file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  /// Status 2, one sentence, no new file.
  void expect_refused(const CommandResult& result, const std::string& sentence) const {
    EXPECT_EQ(result.status, 2) << result.output << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(sentence));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.output, "");
  }

  test::TemporaryFolder folder_;
  fs::path file_{folder_ / "S01.h5"};
  fs::path saved_{folder_ / "S01.recovered.h5"};
};

TEST_F(RecoverCommandTest, AHealthyFileComesBackWithTheSameScores) {
  const std::string before = test::read_text(file_);
  const std::uint64_t rows = record::SessionReader(file_).sample_count();
  const CommandResult result = haptrial("recover", file_);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(
      result.output,
      AllOf(HasSubstr("subject     S01"), HasSubstr("rows        " + std::to_string(rows) + ", "),
            HasSubstr(" 0 missing between them"), HasSubstr("passes      6, 0 incomplete"),
            HasSubstr("complete"), HasSubstr(saved_.string())));
  EXPECT_EQ(test::read_text(file_), before) << "it is as it was";
  const CommandResult info = haptrial("info", saved_);
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_THAT(info.output, AllOf(HasSubstr("recovered"), HasSubstr("intact: every tick")));
  const fs::path again = in_new_folder("again", saved_);
  const fs::path first = in_new_folder("first", file_);
  ASSERT_EQ(haptrial("analyze", again).status, 0);
  ASSERT_EQ(haptrial("analyze", first).status, 0);
  EXPECT_EQ(test::read_text(again / "scores.csv"), test::read_text(first / "scores.csv"));
}

TEST_F(RecoverCommandTest, OfAFileThatWasCutOffTheBeginningIsSaved) {
  fs::resize_file(file_, fs::file_size(file_) * 7 / 10);
  expect_refused(haptrial("info", file_), "(it ends after ");
  expect_refused(haptrial("info", file_), "haptrial recover");
  const CommandResult result = haptrial("recover", file_);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("subject     S01"));
  const record::SessionReader saved(saved_);
  const record::SessionReader whole(folder_ / "study/S01.h5");
  const std::uint64_t rows = saved.sample_count();
  EXPECT_GT(rows, whole.sample_count() / 4);
  EXPECT_LT(rows, whole.sample_count());
  const auto kept = saved.samples(rows - 1, 1);
  const auto original = whole.samples(rows - 1, 1);
  EXPECT_EQ(kept[0].sequence, original[0].sequence);
  EXPECT_EQ(kept[0].position, original[0].position);
  EXPECT_EQ(haptrial("info", saved_).status, 1) << "it opens, and is not complete";
}

TEST_F(RecoverCommandTest, DamageInTheMiddleCostsWhatItTouchesAndTheRestIsScored) {
  {
    std::fstream out(file_, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(static_cast<std::streamoff>(fs::file_size(file_) / 2));
    out << std::string(4096, '\x5a');
  }
  const CommandResult result = haptrial("recover", file_);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output.find(" 0 missing between them"), std::string::npos) << result.output;
  const CommandResult info = haptrial("info", saved_);
  EXPECT_EQ(info.status, 1) << info.output;
  EXPECT_THAT(info.output, AllOf(HasSubstr("gaps"), HasSubstr("NOT intact")));
  const fs::path folder = in_new_folder("part", saved_);
  const CommandResult analysis = haptrial("analyze", folder);
  ASSERT_EQ(analysis.status, 0) << analysis.errors;
  const std::size_t scored = lines_in(folder / "scores.csv") - 1;
  EXPECT_GE(scored, 1u) << "a trial whose rows are all there";
  EXPECT_LE(scored, 3u);
}

TEST_F(RecoverCommandTest, WhatIsNoSessionIsSaidAndNothingIsWritten) {
  test::write_text(folder_ / "notes.txt", std::string(20000, 'n'));
  const CommandResult text = haptrial("recover", folder_ / "notes.txt");
  EXPECT_EQ(text.status, 1);
  EXPECT_THAT(text.output, HasSubstr("nothing of a session is left in its 20000 bytes"));
  EXPECT_FALSE(fs::exists(folder_ / "notes.recovered.h5"));
  test::write_text(folder_ / "empty.h5", "");
  EXPECT_EQ(haptrial("recover", folder_ / "empty.h5").status, 1);
  EXPECT_FALSE(fs::exists(folder_ / "empty.recovered.h5"));
  expect_refused(haptrial("recover", folder_ / "study"), "is not a file");
  expect_refused(haptrial("recover", folder_ / "absent.h5"), "absent.h5");
}

TEST_F(RecoverCommandTest, NothingIsOverwrittenAndAnotherNameCanBeGiven) {
  test::write_text(saved_, "mine");
  expect_refused(haptrial("recover", file_), "S01.recovered.h5: exists");
  EXPECT_EQ(test::read_text(saved_), "mine");
  const fs::path other = folder_ / "other.h5";
  EXPECT_EQ(haptrial("recover", file_, other.string()).status, 0);
  EXPECT_EQ(haptrial("info", other).status, 0);
  expect_refused(haptrial("recover", file_, file_.string()), "exists");
}

}  // namespace
}  // namespace haptrial
