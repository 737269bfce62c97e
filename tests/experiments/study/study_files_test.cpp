// Which files of a folder are sessions of the study: a copy of a session is none of its own.

#include "experiments/study/study_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/analysis/exchange/small_session.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::study_files_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A backup made in the middle of a session holds less of it than the session's own file.
TEST(StudyFilesTest, OfCopiesTheFileWithTheMostPassesStays) {
  const test::TemporaryFolder folder;
  const auto file = [&](const char* name, const exchange::SmallSession& session) {
    exchange::write_session(folder / name, session);
    return folder / name;
  };
  const auto backup = file("P01 backup.h5", {.trials = 2});
  const auto whole = file("P01.h5", {.trials = 3});
  const auto again = file("P01-again.h5", {.trials = 3});
  const auto later = file("P01-later.h5", {.start_utc = "2026-11-21T09:30:00Z"});
  const auto other = file("P02.h5", {.subject = "P02"});
  const DistinctSessions found = distinct_sessions({backup, whole, again, later, other});
  EXPECT_THAT(found.files, ElementsAre(whole, later, other));
  EXPECT_THAT(found.copies, ElementsAre("P01 backup.h5 (of P01.h5)", "P01-again.h5 (of P01.h5)"));
}

TEST(StudyFilesTest, ACopyIsLeftOutOfAnAnalysisWhichSaysSo) {
  const test::TemporaryFolder folder;
  const auto run = [&](const std::string& line) {
    return test::run_command("cd '" + folder.path().string() + "'\n" + line);
  };
  const auto made = run(
      "set -e\nhaptrial new study.toml --from stiffness_discrimination\n"
      "haptrial dry-run study.toml --subjects 2 --trials 8 --out study\n"
      "haptrial analyze study\ncp study/trials.csv alone.csv\ncp study/S01.h5 'study/S01 copy.h5'\n"
      "cp study/S02.h5 elsewhere.h5");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output, Not(HasSubstr("same session")));
  const auto again = run("haptrial analyze study && cmp study/trials.csv alone.csv");
  EXPECT_EQ(again.status, 0) << again.errors;
  EXPECT_THAT(
      again.output,
      HasSubstr("Not analysed, because another file holds the same session: S01 copy.h5 (of "
                "S01.h5)."));
  EXPECT_THAT(test::read_text(folder / "study/report.md"), HasSubstr("S01 copy.h5"));
  const auto listed = run("haptrial roster study.toml study");
  EXPECT_THAT(listed.output + listed.errors, HasSubstr("holds the same session"));
  const auto exported = run("haptrial export study/S02.h5 elsewhere.h5 --csv out");
  EXPECT_EQ(exported.status, 2);
  EXPECT_THAT(exported.errors, HasSubstr("elsewhere.h5: holds the same session as study/S02.h5"));
}

TEST(StudyFilesTest, ASessionThatWasRecordedTwiceIsSaid) {
  const test::TemporaryFolder folder;
  const auto done = test::run_command(
      "set -e\ncd '" + folder.path().string() +
      "'\nhaptrial new study.toml --from stiffness_discrimination\n"
      "haptrial dry-run study.toml --subjects 1 --trials 8 --out study\nsleep 1.1\n"
      "haptrial dry-run study.toml --subjects 1 --trials 8 --out later\n"
      "cp later/S01.h5 study/later.h5\nhaptrial analyze study");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("Recorded more than once, and all of it analysed: S01 session "
                                     "1: S01.h5, later.h5."));
}

TEST(StudyFilesTest, SessionsOfDifferentSeedsAreSaid) {
  const test::TemporaryFolder folder;
  const auto done =
      test::run_command("set -e\ncd '" + folder.path().string() +
                        "'\nhaptrial new study.toml --from stiffness_discrimination\n"
                        "haptrial dry-run study.toml --subjects 1 --trials 8 --seed 5 --out study\n"
                        "haptrial dry-run study.toml --subjects 2 --trials 8 --out other\n"
                        "cp other/S02.h5 study\nhaptrial analyze study");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("Recorded with different seeds, over which orders are not "
                                     "balanced: seed 1: S02.h5; seed 5: S01.h5."));
}

}  // namespace
}  // namespace haptrial::experiments::study_files_test
