// A script that is asked for levels: what it may do, and that nothing of it stops a session.

#include "protocols/psychophysics/sequence/scripted_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/support/temporary_folder.h"

namespace haptrial::protocols::level_script_test {
namespace {

using psychometric::Level;
using testing::HasSubstr;

class LevelScriptTest : public testing::Test {
 protected:
  /// A program in the shell that reads a line for each answer.
  LevelScript script(const std::string& body, double deadline = 60.0,
                     double longest_start = 60.0) const {
    const std::filesystem::path file = folder_ / "levels.sh";
    std::ofstream(file) << "#!/bin/sh\n" << body << "\n";
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return LevelScript(file, deadline, longest_start);
  }
  std::string why_not(const std::string& body, double deadline = 60.0,
                      double longest_start = 60.0) const {
    LevelScript asked = script(body, deadline, longest_start);
    const LevelScript::Answer answer = asked.ask("{}", 1);
    EXPECT_FALSE(answer.level);
    return answer.why_not;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LevelScriptTest, AnswersEachQuestionInTurn) {
  LevelScript echo =
      script("while read line; do echo noise; echo \"{\\\"level\\\": $line}\"; done");
  EXPECT_EQ(echo.ask("2.5", 1).level, Level{2.5});
  EXPECT_EQ(echo.ask("-3e-2", 1).level, Level{-0.03});
  EXPECT_EQ(echo.ask("[1, 2]", 2).level, (Level{1.0, 2.0}));
}

TEST_F(LevelScriptTest, WhatIsNoLevelGetsASentence) {
  EXPECT_THAT(why_not("read line; echo '{\"level\": null}'; cat"), HasSubstr("left the choice"));
  EXPECT_THAT(why_not("read line; echo '{\"level\": \"much\"}'; cat"), HasSubstr("was \"much\""));
  EXPECT_THAT(why_not("read line; echo '{\"level\": [1, 2]}'; cat"), HasSubstr("not a number"));
  EXPECT_THAT(why_not("read line; echo 'Traceback: no such thing' >&2; exit 1"),
              HasSubstr("ended with no level: Traceback: no such thing"));
  EXPECT_THAT(why_not("exit 0"), HasSubstr("ended with no level"));
  EXPECT_THAT(why_not("kill -KILL $$"), HasSubstr("ended with no level"));
}

TEST_F(LevelScriptTest, OneThatHangsIsLeftAtItsDeadline) {
  EXPECT_THAT(why_not("read line; sleep 1000", 0.2), HasSubstr("no level within 0.2 s"));
  EXPECT_THAT(why_not("read line; while true; do echo busy; done", 0.2), HasSubstr("within 0.2 s"));
  EXPECT_THAT(why_not("while true; do echo busy; done", 60.0, 0.2),
              HasSubstr("did not read its question within 0.2 s after its start"));
}

TEST_F(LevelScriptTest, ItsStartDoesNotCountAgainstTheDeadline) {
  LevelScript slow =
      script("sleep 1\nwhile read line; do echo \"{\\\"level\\\": $line}\"; done", 0.5);
  EXPECT_EQ(slow.ask("2.5", 1).level, Level{2.5});
  EXPECT_EQ(slow.ask("3.5", 1).level, Level{3.5});
}

TEST_F(LevelScriptTest, ItMayBeStartedBeforeItsFirstQuestion) {
  const std::filesystem::path up = folder_ / "up";
  LevelScript early = script("touch '" + up.string() + "'\nread line; echo '{\"level\": 1}'; cat");
  early.start_early();
  while (!std::filesystem::exists(up)) {
    std::this_thread::yield();
  }
  EXPECT_EQ(early.ask("{}", 1).level, Level{1.0});
  LevelScript missing(folder_ / "none.sh", 1.0);
  missing.start_early();
  EXPECT_THAT(missing.ask("{}", 1).why_not, HasSubstr("cannot be started"));
}

TEST_F(LevelScriptTest, OneThatEndedIsStartedAgain) {
  const std::string mark = (folder_ / "mark").string();
  LevelScript once = script("read line; if [ -e '" + mark +
                            "' ]; then echo '{\"level\": 7}'; cat; fi; touch '" + mark + "'");
  EXPECT_FALSE(once.ask("{}", 1).level);
  EXPECT_EQ(once.ask("{}", 1).level, Level{7.0});
}

TEST_F(LevelScriptTest, AFileThatIsNoProgramGetsASentence) {
  LevelScript missing(folder_ / "none.sh", 1.0);
  EXPECT_THAT(missing.ask("{}", 1).why_not, HasSubstr("cannot be started"));
}

TEST_F(LevelScriptTest, WhoeverWaitsMayGiveUp) {
  LevelScript slow = script("sleep 1000");
  EXPECT_THROW(slow.ask("{}", 1, [] { throw std::runtime_error("interrupted"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace haptrial::protocols::level_script_test
