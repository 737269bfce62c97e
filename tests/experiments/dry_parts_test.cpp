// haptrial dry-run --parts: the folder is the state.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

class DryPartsTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }
  static std::string dry_run(const std::string& more) {
    return "haptrial dry-run '" HAPTRIAL_SOURCE_DIR
           "/experiments/stiffness_discrimination.toml' --subjects 4 --trials 2 " +
           more;
  }
  void expect_refused(const std::string& line, const std::string& sentence) const {
    const CommandResult result = run_command(line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << line;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
  /// Four sessions with the trials that a run into a new folder gives, and nothing unfinished.
  void expect_whole(const std::string& name) const {
    for (const std::string& command :
         {dry_run("--out " + path("whole")), "haptrial analyze " + path("whole"),
          "haptrial analyze " + path(name)}) {
      ASSERT_EQ(run_command(command).status, 0) << command;
    }
    EXPECT_EQ(test::read_text(folder_ / name / "trials.csv"),
              test::read_text(folder_ / "whole/trials.csv"));
    int sessions = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / name)) {
      EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
      sessions += entry.path().extension() == ".h5" ? 1 : 0;
    }
    EXPECT_EQ(sessions, 4);
  }
  test::TemporaryFolder folder_;
};

TEST_F(DryPartsTest, KilledRunsGoOnAndNothingIsRunTwice) {
  // Killed as soon as there is one session, then two.
  const CommandResult killed = run_command("for n in 1 2; do \"$HAPTRIAL\" " +
                                           dry_run("--jobs 1 --parts " + path("parts")).substr(9) +
                                           " & while [ $(ls " + path("parts") +
                                           "/*.h5 2>/dev/null | wc -l) -lt $n ]; do :; done; "
                                           "kill -9 $!; wait $! 2>/dev/null; done; ls " +
                                           path("parts") + "/*.h5 | wc -l");
  const int there =
      std::stoi(killed.output.substr(killed.output.rfind('\n', killed.output.size() - 2) + 1));
  ASSERT_GE(there, 2);
  ASSERT_LT(there, 4) << "no kill came in the middle";
  const CommandResult rest = run_command(dry_run("--parts " + path("parts")));
  EXPECT_EQ(rest.status, 0) << rest.errors;
  EXPECT_THAT(rest.output, HasSubstr(std::to_string(4 - there) + " session"));
  EXPECT_THAT(run_command(dry_run("--parts " + path("parts"))).output, HasSubstr("0 sessions, "));
  expect_whole("parts");
}

TEST_F(DryPartsTest, ProcessesShareTheSessions) {
  const std::string one = dry_run("--jobs 1 --parts " + path("parts"));
  const CommandResult both = run_command(one + " & " + one + "; wait");
  // Each says how many it ran, one of them perhaps none, beside sentences of other kinds.
  int ran = 0;
  const std::regex kRan("(^|\n)([0-9]+) sessions?, ");
  for (std::sregex_iterator it(both.output.begin(), both.output.end(), kRan), end; it != end;
       ++it) {
    ran += std::stoi((*it)[2]);
  }
  EXPECT_EQ(ran, 4) << "a session was run twice\n" << both.output << both.errors;
  expect_whole("parts");
}

TEST_F(DryPartsTest, OtherSessionsAreRefused) {
  const std::string parts = "--parts " + path("parts");
  const std::string one = "haptrial dry-run '" + test::shipped_definition().string() +
                          "' --subjects 1 --trials 1 " + parts;
  ASSERT_EQ(run_command(one).status, 0);
  expect_refused(one + " --seed 2",
                 "holds sessions of another definition, script, seed or program");
  expect_refused(dry_run(parts), "holds sessions of another definition, script, seed or program");
  expect_refused(one + " --out x", "--out is given together with --parts; leave it out");
  expect_refused(one + " --taught", "--taught is given together with --parts");
  expect_refused(one + " --frames 2", "--frames is given together with --parts");
  fs::remove(folder_ / "parts/dry-run.toml");
  expect_refused(one, "holds something else; choose a new folder with --parts");
  expect_refused(dry_run("--parts /proc/sessions"), "/proc/sessions: cannot be made");
}

TEST_F(DryPartsTest, AnotherScriptIsRefused) {
  test::write_text(
      folder_ / "study.toml",
      test::read_text(HAPTRIAL_SOURCE_DIR "/experiments/stiffness_discrimination.toml") +
          "\n[observer.script]\nfile = \"answers.py\"\n");
  const auto says = [this](const char* answer) {
    test::write_text(folder_ / "answers.py",
                     "import sys\nfor line in sys.stdin:\n    print('{\"answer\": " +
                         std::string(answer) + "}', flush=True)\n");
  };
  const std::string one = "haptrial dry-run " + path("study.toml") +
                          " --subjects 1 --trials 1 --parts " + path("parts");
  says("\"first\"");
  const CommandResult first = run_command(one);
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_EQ(run_command(one).status, 0);
  says("null");
  expect_refused(one, "holds sessions of another definition, script, seed or program");
}

}  // namespace
}  // namespace haptrial
