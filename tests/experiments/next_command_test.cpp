// A study that may end before its last participant, as a command.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/file_text.h"
#include "core/record/hdf5/file_lock.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::next_command_test {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

class NextCommandTest : public testing::Test {
 protected:
  NextCommandTest() {
    const fs::path worked = HAPTRIAL_SOURCE_DIR "/docs/worked/everyday";
    for (const char* file : {"crossmodal_congruency.toml", "congruency.py"}) {
      fs::copy_file(worked / file, folder_ / file);
    }
  }
  CommandResult run(const std::string& command) const {
    return run_command("cd '" + folder_.path().string() + "' && haptrial " + command);
  }
  void set(const std::string& key, const std::string& value) const {
    const CommandResult done = run("set crossmodal_congruency.toml analysis." + key + " " + value);
    EXPECT_EQ(done.status, 0) << done.errors;
  }
  void rehearse(int participants) const {
    const CommandResult done = run("dry-run crossmodal_congruency.toml --subjects " +
                                   std::to_string(participants) + " --out out");
    EXPECT_EQ(done.status, 0) << done.errors;
  }
  CommandResult next() const { return run("next crossmodal_congruency.toml out"); }

  test::TemporaryFolder folder_;
};

/// Lights beside the other finger slow everybody down, so a few participants decide.
TEST_F(NextCommandTest, ADecidedStudyAsksForNobody) {
  set("sequential.rule", "'\"bayes factor\"'");
  set("sequential.fewest", "2");
  EXPECT_THAT(next().output, HasSubstr("next: "));  // nobody has come
  rehearse(5);
  const CommandResult decided = next();
  EXPECT_EQ(decided.status, 0) << decided.errors;
  EXPECT_THAT(decided.output, HasSubstr("the study has ended: there is an effect"));
  EXPECT_THAT(decided.output, Not(HasSubstr("next: ")));
  const CommandResult roster = run("roster crossmodal_congruency.toml out --json roster.json");
  EXPECT_EQ(roster.status, 0) << roster.errors;
  EXPECT_THAT(roster.output, HasSubstr("the study has ended: there is an effect"));
  EXPECT_THAT(roster.output, HasSubstr("nobody is next"));
  EXPECT_THAT(roster.output, Not(HasSubstr("next: ")));
  const auto json = nlohmann::json::parse(file_text(folder_ / "roster.json"));
  EXPECT_EQ(json["ended"], true);
  EXPECT_TRUE(json["next"].empty());
  EXPECT_THAT(run("start crossmodal_congruency.toml --check --out out").output,
              HasSubstr("the study has ended: there is an effect"));
  EXPECT_THAT(run("run crossmodal_congruency.toml --out more --subject S06 --trials 1").output,
              Not(HasSubstr("the study has ended")))
      << "nobody has come there";
  EXPECT_THAT(run("run crossmodal_congruency.toml --out out --subject S06 --trials 1").output,
              testing::ContainsRegex("warning: congruent < incongruent, .*the study has ended: "
                                     "there is an effect.*recording "));
  EXPECT_THAT(run("analyze out").output,
              HasSubstr("Mean reaction time. When the study ends: congruent < incongruent, after"));
  EXPECT_THAT(file_text(folder_ / "out/results.json"), HasSubstr("\"most_participants\": 12"));
}

TEST_F(NextCommandTest, WhoIsBeingRecordedIsNotDone) {
  ASSERT_EQ(run("set crossmodal_congruency.toml design.participants 2").status, 0);
  rehearse(2);
  EXPECT_THAT(next().output, HasSubstr("every planned participant has had every session"));
  fs::rename(folder_ / "out/S02.h5", folder_ / "out/S02.h5.partial");
  const auto recording = record::FileLock::take(folder_ / "out/S02.h5.partial", false);
  EXPECT_THAT(next().output, HasSubstr("S02 is being recorded; nobody else is next"));
  EXPECT_THAT(run("roster crossmodal_congruency.toml out").output,
              testing::AllOf(HasSubstr("2 of 2 participants begun, 1 with their session"),
                             HasSubstr("S02 is being recorded; nobody else is next")));
}

/// Five people come on two days; the fifth has had the first day alone.
TEST_F(NextCommandTest, PeopleCountWithEverySessionAndKeepThoseThatTheyHaveLeft) {
  set("sequential.rule", "'\"bayes factor\"'");
  set("sequential.fewest", "2");
  ASSERT_EQ(run("set crossmodal_congruency.toml design.sessions 2").status, 0);
  rehearse(5);
  fs::remove(folder_ / "out/S05-session-2.h5");
  const std::string ended = "the study has ended: there is an effect";
  EXPECT_THAT(next().output, testing::AllOf(HasSubstr(ended), HasSubstr("next: S05, session 2")));
  EXPECT_THAT(
      run("roster crossmodal_congruency.toml out").output,
      testing::AllOf(HasSubstr(ended), HasSubstr("next: S05, session 2"), Not(HasSubstr("S06"))));
  const std::string run_out = "run crossmodal_congruency.toml --trials 1 --out out --subject ";
  EXPECT_THAT(run(run_out + "S06").output, HasSubstr(ended));
  const auto left = run(run_out + "S05 --session 2");
  EXPECT_EQ(left.status, 0) << left.errors;
  EXPECT_THAT(left.output, testing::AllOf(HasSubstr("recording "), Not(HasSubstr(ended))));
  for (const char* file : {"S03-session-2.h5", "S04-session-2.h5", "S05-session-2.h5"}) {
    fs::remove(folder_ / "out" / file);
  }
  EXPECT_THAT(next().output,
              testing::AllOf(HasSubstr("after 2 of at most 12 participants"), HasSubstr("go on")));
}

TEST_F(NextCommandTest, BetweenLooksItGoesOn) {
  set("sequential.rule", "'\"group sequential\"'");
  set("sequential.looks", "'[4.0, 12.0]'");
  rehearse(3);
  EXPECT_THAT(next().output,
              testing::AllOf(HasSubstr("not looked at yet; go on"),
                             HasSubstr("at most 12 participants"), HasSubstr("next: ")));
  EXPECT_THAT(run("roster crossmodal_congruency.toml out").output,
              testing::AllOf(HasSubstr("not looked at yet; go on"), HasSubstr("next: ")));
}

TEST_F(NextCommandTest, LooksThatNobodyReachesAreWarnedOf) {
  set("sequential.rule", "'\"group sequential\"'");
  set("sequential.looks", "'[6.0, 40.0]'");
  EXPECT_THAT(run("validate crossmodal_congruency.toml").output,
              HasSubstr("after 40 participants, but design.participants is 12"));
}

TEST_F(NextCommandTest, ARuleThatMissesEffectsIsWarnedOf) {
  set("sequential.rule", "'\"bayes factor\"'");
  EXPECT_THAT(run("validate crossmodal_congruency.toml").output, Not(HasSubstr("sequential")));
  set("sequential.none", "3.0");
  set("sequential.fewest", "20");
  EXPECT_THAT(run("validate crossmodal_congruency.toml").output,
              testing::AllOf(HasSubstr("with 3, about one study in six"),
                             HasSubstr("fewest is 20, but design.participants is 12")));
}

TEST_F(NextCommandTest, ARuleOfAnotherQuantityThanThePlannedOneIsWarnedOf) {
  const auto warned = HasSubstr("ends by a test of another quantity");
  set("tests_of", "'\"share_wrong\"'");
  set("sequential.rule", "'\"bayes factor\"'");
  EXPECT_THAT(run("validate crossmodal_congruency.toml").output, Not(warned));
  ASSERT_EQ(run("plan crossmodal_congruency.toml --out plan").status, 0);
  EXPECT_THAT(file_text(folder_ / "plan/crossmodal_congruency.plan.json"),
              testing::AllOf(HasSubstr("congruent < incongruent, of share_wrong"),
                             HasSubstr("of analysis.sequential decides, of share_wrong")));
  set("sequential.of", "'\"reaction_time\"'");
  EXPECT_THAT(run("validate crossmodal_congruency.toml").output, warned);
}

TEST_F(NextCommandTest, AFileIsNoFolder) {
  const CommandResult wrong = run("next crossmodal_congruency.toml congruency.py");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("congruency.py: not a folder"));
}

TEST_F(NextCommandTest, AQuantityThatIsNotThereIsNamed) {
  set("sequential.of", "'\"thresholds\"'");
  rehearse(2);
  const CommandResult wrong = next();
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("analysis.sequential.of is \"thresholds\"; allowed: "));
}

}  // namespace
}  // namespace haptrial::next_command_test
