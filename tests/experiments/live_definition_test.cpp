// A session that is resumed with a definition that was edited meanwhile, and pilots.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "core/record/read/session_reader.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::LiveCommand;
using testing::HasSubstr;

class LiveDefinitionTest : public testing::Test {
 protected:
  std::string run(const std::string& options) const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --trials 1 --out '" +
           (folder_ / "out").string() + "' " + options;
  }
  void define(const std::string& text) const { test::write_text(folder_ / "study.toml", text); }
  /// Passes of ten seconds, within which a session can be broken off.
  static std::string slow(std::vector<std::pair<std::string, std::string>> more = {}) {
    more.insert(more.begin(), {"speed", "speed = 0.008"});
    return test::brisk_text(std::move(more));
  }
  /// Ends while its first pass is under way.
  void break_off(const std::string& options = "") const {
    LiveCommand session(run(options));
    ASSERT_TRUE(session.reaches([&] {
      std::error_code ignored;
      return fs::exists(partial(), ignored) && record::SessionReader(partial()).sample_count() > 0;
    })) << session.errors();
    session.signal(SIGINT);
    ASSERT_EQ(session.wait().status, 1);
  }
  fs::path file() const { return folder_ / "out/S01.h5"; }
  fs::path partial() const { return folder_ / "out/S01.h5.partial"; }
  test::TemporaryFolder folder_;
};

TEST_F(LiveDefinitionTest, ATextMayChangeBeforeAResumeAndTheFileKeepsBoth) {
  const std::string first = slow();
  define(first);
  ASSERT_NO_FATAL_FAILURE(break_off());
  std::string second = first + "\n# a comment\n";
  second.replace(second.find("Time for a rest"), 4, "Hour");
  define(second);
  const CommandResult ended = LiveCommand(run("--resume")).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const record::SessionReader reader(file());
  EXPECT_EQ(reader.info().definition, first);
  std::string changed;
  std::string kept;
  for (const record::EventRow& event : reader.events()) {
    changed = event.kind == "definition_changed" ? event.text : changed;
    kept = event.kind == "definition" ? event.text : kept;
  }
  EXPECT_THAT(changed, HasSubstr("texts.rest was \"Time for a rest"));
  EXPECT_EQ(kept, second);
  const CommandResult info = test::run_command("haptrial info '" + file().string() + "'");
  EXPECT_THAT(info.output, HasSubstr("definition_changed"));
  const CommandResult study =
      test::run_command("haptrial analyze '" + (folder_ / "out").string() + "'");
  EXPECT_THAT(study.output,
              HasSubstr("S01.h5 was resumed with a changed definition from trial 1 on: "
                        "texts.rest"));
}

TEST_F(LiveDefinitionTest, WhatWasPresentedMayNotChangeBeforeAResume) {
  define(slow());
  ASSERT_NO_FATAL_FAILURE(break_off());
  define(slow({{"base_max", "base_max = 9.0"}}));
  const CommandResult ended = LiveCommand(run("--resume")).wait();
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("force_pattern.base_max was 10, is 9"));
  EXPECT_TRUE(fs::exists(partial()));
}

TEST_F(LiveDefinitionTest, AFolderTakesOneStudy) {
  const std::string first = test::brisk_text();
  define(first);
  ASSERT_EQ(LiveCommand(run("")).wait().status, 0);
  const auto other = [this](const std::string& subject, const std::string& more = "") {
    std::string line = run(more);
    line.replace(line.find("S01"), 3, subject);
    return LiveCommand(line).wait();
  };
  define("# for the other room\n" + test::brisk_text({{"refresh_lock", "refresh_lock = false"}}));
  const CommandResult screen = other("S02");
  EXPECT_EQ(screen.status, 0) << screen.errors;
  EXPECT_THAT(screen.output, HasSubstr("the definition differs from that of S01.h5: "
                                       "screen.refresh_lock was true, is false; such keys may "
                                       "change within a study\n"));
  define(test::brisk_text({{"trajectory", "trajectory = { stiffness = 800.0, damping = 100.0 }"}}));
  const CommandResult gain = other("S03");
  EXPECT_EQ(gain.status, 2);
  EXPECT_THAT(gain.errors, HasSubstr("S01.h5: was recorded with another definition: "
                                     "guidance.trajectory.stiffness was 900, is 800"));
  EXPECT_FALSE(fs::exists(folder_ / "out/S03.h5.partial"));
  EXPECT_EQ(other("S04", "--pilot").status, 0) << "a pilot may try something else";

  const CommandResult study =
      test::run_command("haptrial analyze '" + (folder_ / "out").string() + "'");
  EXPECT_EQ(study.status, 0) << study.errors;
  EXPECT_THAT(study.output,
              HasSubstr("S02.h5 was recorded with a changed definition: screen.refresh_lock was "
                        "true, is false; such keys may change within a study."));
}

TEST_F(LiveDefinitionTest, APilotIsMarkedAndAnalysedOnlyWhereItIsAskedFor) {
  define(slow());
  ASSERT_NO_FATAL_FAILURE(break_off("--pilot"));
  const CommandResult other = LiveCommand(run("--resume")).wait();
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("was recorded as a pilot; resume it with --pilot"));
  ASSERT_EQ(LiveCommand(run("--resume --pilot")).wait().status, 0);
  EXPECT_TRUE(record::SessionReader(file()).info().pilot);
  EXPECT_THAT(test::run_command("haptrial info '" + file().string() + "'").output,
              HasSubstr("S01 (simulated) (pilot, not part of the study)"));

  const std::string analyze = "haptrial analyze '" + (folder_ / "out").string() + "'";
  const CommandResult alone = test::run_command(analyze);
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.errors, HasSubstr("only pilot sessions; analyse them with --pilots"));
  const std::string study = (folder_ / "study").string();
  const CommandResult both = test::run_command(
      "set -e; haptrial dry-run '" + (folder_ / "study.toml").string() +
      "' --subjects 2 --trials 3 --out '" + study + "'; cp '" + file().string() + "' '" + study +
      "/P01.h5'; haptrial analyze '" + study + "'; cp '" + study + "/scores.csv' '" +
      (folder_ / "without.csv").string() + "'; haptrial analyze --pilots '" + study +
      "'; haptrial analyze --pilots '" + study + "'");
  ASSERT_EQ(both.status, 0) << both.errors;
  EXPECT_THAT(both.output, HasSubstr("because the session was a pilot: P01.h5."));
  EXPECT_THAT(both.output, HasSubstr("These are pilot sessions, not the study."));
  EXPECT_THAT(test::read_text(folder_ / "without.csv"), HasSubstr("S02,"));
  EXPECT_THAT(test::read_text(folder_ / "without.csv"), testing::Not(HasSubstr("S03,")));
  EXPECT_THAT(both.output, HasSubstr("report: " + study + "/pilots/report.html"));
  EXPECT_THAT(test::read_text(study + "/pilots/scores.csv"), testing::Not(HasSubstr("S02,")));
  EXPECT_THAT(test::read_text(study + "/pilots/scores.csv"), HasSubstr("\nS01,"));
  EXPECT_EQ(test::read_text(study + "/scores.csv"), test::read_text(folder_ / "without.csv"))
      << "the study's own report stays";
  const std::string curves = (folder_ / "curves").string();
  const CommandResult out =
      test::run_command("haptrial export --curves '" + curves + "' '" + study + "'");
  EXPECT_THAT(out.output, HasSubstr("Not exported, because the session was a pilot: P01.h5."));
  EXPECT_THAT(test::read_text(curves + "/conditions.csv"), HasSubstr("\nS02,"));
  const CommandResult alone_out = test::run_command("haptrial export --curves '" + curves +
                                                    "-of-pilot' '" + study + "/P01.h5'");
  EXPECT_THAT(alone_out.output, HasSubstr("These are pilot sessions, not the study."));
}

}  // namespace
}  // namespace haptrial
