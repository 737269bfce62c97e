#include "analysis/force_training/report/write_analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/analysis/force_training/example_study.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class WriteAnalysis : public testing::Test {
 protected:
  WriteAnalysis() : root_(fs::path(testing::TempDir()) / ("write-" + std::to_string(getpid()))) {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~WriteAnalysis() override { fs::remove_all(root_); }

  static std::set<std::string> names(const fs::path& folder) {
    std::set<std::string> result;
    for (const auto& entry : fs::directory_iterator(folder)) {
      result.insert(entry.path().filename().string());
    }
    return result;
  }

  fs::path root_;
};

TEST_F(WriteAnalysis, MakesTheFolderAndEveryFile) {
  const auto study = example_study(true);
  write_analysis(study, root_ / "a" / "b");
  const auto found = names(root_ / "a" / "b");
  EXPECT_EQ(found.size(), 26u);  // table, numbers, two reports, eleven figures twice
  EXPECT_EQ(file_text(root_ / "a" / "b" / "scores.csv"), scores_csv(study.scores));
  const auto report = file_text(root_ / "a" / "b" / "report.html");
  EXPECT_THAT(report, HasSubstr("SIMULATED PARTICIPANTS</text>"));  // in the pictures too
  EXPECT_THAT(report, HasSubstr("figure-28-recall-error-gpPt"));
}

TEST_F(WriteAnalysis, ReplacesAnEarlierOneAndTouchesNothingElse) {
  std::ofstream(root_ / "session.h5") << "data";
  write_analysis(example_study(true), root_);
  write_analysis(example_study(false), root_);
  EXPECT_THAT(file_text(root_ / "report.html"), testing::Not(HasSubstr("SIMULATED")));
  EXPECT_EQ(file_text(root_ / "session.h5"), "data");
  EXPECT_EQ(names(root_).size(), 27u);  // no temporary folder
}

TEST_F(WriteAnalysis, GivesTheSameBytesTwice) {
  write_analysis(example_study(true), root_ / "1");
  write_analysis(example_study(true), root_ / "2");
  for (const auto& name : names(root_ / "1")) {
    if (!name.ends_with(".png")) {
      EXPECT_EQ(file_text(root_ / "1" / name), file_text(root_ / "2" / name)) << name;
    }
  }
}

TEST_F(WriteAnalysis, SaysThatTheFolderCannotBeWritten) {
  std::ofstream(root_ / "file") << "x";
  try {
    write_analysis(example_study(true), root_ / "file");
    ADD_FAILURE() << "wrote into a file";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is not a folder"));
  }
  EXPECT_THROW(write_analysis(example_study(true), "/proc/nothing/here"), InputError);
}

TEST_F(WriteAnalysis, LeavesAnEarlierOneWhenGnuplotIsAbsent) {
  write_analysis(example_study(true), root_);
  const std::string before = file_text(root_ / "report.html");
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", root_.c_str(), 1);
  EXPECT_THROW(write_analysis(example_study(false), root_), RunError);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(file_text(root_ / "report.html"), before);
  EXPECT_EQ(names(root_).size(), 26u);
}

// A limit on the size of files stands in for a full disk.
TEST_F(WriteAnalysis, SaysThatTheDiskIsFull) {
  const auto study = example_study(true);
  EXPECT_EXIT(
      {
        std::signal(SIGXFSZ, SIG_IGN);
        rlimit limit{};
        limit.rlim_cur = limit.rlim_max = 4096;
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
          write_analysis(study, root_);
        } catch (const RunError& error) {
          std::fputs(error.what(), stderr);
          std::_Exit(names(root_).empty() ? 7 : 8);
        }
        std::_Exit(9);
      },
      testing::ExitedWithCode(7), "scores.csv: could not be written: File too large");
}

}  // namespace
}  // namespace haptrial::analysis
