// Breaks, practice, resumed attempts and a participant's Escape, as an
// experimenter meets them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/record/read/session_reader.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::ConsolePerson;
using test::LiveCommand;
using testing::HasSubstr;

class LiveBreaksTest : public testing::Test {
 protected:
  using Lines = std::vector<std::pair<std::string, std::string>>;
  std::string run(const Lines& more, const std::string& options = "--console") const {
    Lines lines{{"repetitions", "repetitions = 1"},
                {"break_after", "break_after = 1"},
                {"break_duration", "break_duration = 3600.0"}};
    lines.insert(lines.end(), more.begin(), more.end());
    test::write_text(folder_ / "study.toml", test::attended_text(lines));
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' " + options;
  }
  static void come_to_the_break(ConsolePerson& person) {
    ASSERT_TRUE(person.sees("instructions"));
    ASSERT_TRUE(person.ask("start"));
    ASSERT_TRUE(person.sees("running", "run"));
    ASSERT_TRUE(person.ask("skip"));
    ASSERT_TRUE(person.sees("break"));
  }
  test::TemporaryFolder folder_;
};

TEST_F(LiveBreaksTest, ABreakEndsBeforeItsTimeWhenTheExperimenterStarts) {
  LiveCommand session(run({}));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(come_to_the_break(person));
  EXPECT_THAT(person.status()["screen"].get<std::string>(), HasSubstr("Let go of the handle"));
  ASSERT_TRUE(person.ask("start"));
  EXPECT_TRUE(person.sees("running", "run"));
  EXPECT_EQ(person.status()["trial"], 2);
}

TEST_F(LiveBreaksTest, ABreakUntilReadyLastsItsTimeAndThenUntilTheExperimenterStarts) {
  LiveCommand session(run({{"break_duration", "break_duration = 6.0\nbreak_until = \"ready\""}}));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(come_to_the_break(person));
  ASSERT_TRUE(person.ask("start"));  // before its time
  std::this_thread::sleep_for(std::chrono::milliseconds(7500));
  EXPECT_EQ(person.status()["state"], "break") << "its time is over, and nobody was ready since";
  ASSERT_TRUE(person.ask("start"));
  EXPECT_TRUE(person.sees("running", "run"));
  EXPECT_EQ(person.status()["trial"], 2);
}

TEST_F(LiveBreaksTest, ABreakUntilReadyEndsWhenTheParticipantPressesEnter) {
  const test::VirtualDisplay display(1280, 720);
  LiveCommand session(run({{"break_duration", "break_duration = 0.5\nbreak_until = \"ready\""}},
                          "--console --window"));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(come_to_the_break(person));
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(person.status()["state"], "break");
  display.press_key("haptrial", test::VirtualDisplay::kEnter);
  EXPECT_TRUE(person.sees("running", "run"));
  EXPECT_EQ(person.status()["trial"], 2);
}

TEST_F(LiveBreaksTest, AnEmergencyStopInABreakIsSeenAndStays) {
  LiveCommand session(run({}));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(come_to_the_break(person));
  ASSERT_TRUE(person.ask("emergency_stop"));
  EXPECT_TRUE(person.sees("stopped"));
}

TEST_F(LiveBreaksTest, ASessionThatIsEndedBeforeItsBreakHasNone) {
  LiveCommand session(run({}));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("running", "run"));
  ASSERT_TRUE(person.ask("end"));
  ASSERT_EQ(session.wait().status, 0);
  for (const record::EventRow& event : record::SessionReader(folder_ / "out/S01.h5").events()) {
    EXPECT_NE(event.kind, "break");
  }
}

TEST_F(LiveBreaksTest, ThePracticeTextIsShownBeforeThePractice) {
  LiveCommand session(run({{"practice", "practice = 1"}}));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  ASSERT_TRUE(person.ask("start"));
  test::wait_until([&] {
    return person.status()["screen"].get<std::string>().find("These trials do not count") !=
           std::string::npos;
  });
}

TEST_F(LiveBreaksTest, AttemptsAreCountedOnAfterAResume) {
  {
    LiveCommand session(run({}));
    ConsolePerson person(session.line_after("console: "));
    ASSERT_TRUE(person.sees("instructions"));
    ASSERT_TRUE(person.ask("start"));
    ASSERT_TRUE(person.sees("running", "run"));
    session.signal(SIGTERM);
    ASSERT_EQ(session.wait().status, 1);
  }
  LiveCommand again(run({}, "--console --resume"));
  ConsolePerson person(again.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("running", "run"));
  ASSERT_TRUE(person.ask("end"));
  ASSERT_EQ(again.wait().status, 0);
  const auto passes = record::SessionReader(folder_ / "out/S01.h5").passes();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[1].trial, 1);
  EXPECT_EQ(passes[1].attempt, 2);
}

TEST_F(LiveBreaksTest, TheParticipantReadsWhyNothingHappens) {
  // The pass that is under way when the session is paused comes to its end.
  LiveCommand session(run({{"recovery", "recovery = 2.0"}, {"speed", "speed = 0.02"}}));
  ConsolePerson person(session.line_after("console: "));
  const auto reads = [&person](const std::string& state, const std::string& text) {
    return person.sees(state) &&
           person.seen()["screen"].get<std::string>().find(text) != std::string::npos;
  };
  ASSERT_TRUE(person.sees("instructions"));
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("running", "run"));
  ASSERT_TRUE(person.ask("repeat"));  // the pass is aborted without a fault
  EXPECT_TRUE(reads("recovering", "One moment"));
  ASSERT_TRUE(person.sees("running", "run"));
  EXPECT_EQ(person.seen()["screen"], "");
  ASSERT_TRUE(person.ask("pause"));
  EXPECT_TRUE(reads("paused", "A short pause"));
  ASSERT_TRUE(person.ask("emergency_stop"));
  EXPECT_TRUE(reads("stopped", "The forces are off"));
  ASSERT_TRUE(person.ask("clear"));
  EXPECT_TRUE(reads("paused", "A short pause"));
}

TEST_F(LiveBreaksTest, ASkippedTrialDoesNotComeAgainAfterAResume) {
  {
    LiveCommand session(run({}));
    ConsolePerson person(session.line_after("console: "));
    ASSERT_NO_FATAL_FAILURE(come_to_the_break(person));  // trial 1 is skipped
    session.signal(SIGTERM);
    ASSERT_EQ(session.wait().status, 1);
  }
  LiveCommand again(run({}, "--console --resume"));
  ConsolePerson person(again.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  EXPECT_THAT(again.line_after("recording "), HasSubstr("1 of them done already"));
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("running", "run"));
  EXPECT_EQ(person.status()["trial"], 2);
}

TEST_F(LiveBreaksTest, TheConsoleSpeaksOfThePlannedTrialsAndOfTheDefinitions) {
  LiveCommand session(run({}, "--console --trials 3 --lsl-optional"));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  const nlohmann::json now = person.status();
  EXPECT_EQ(now["trials"], 3);
  EXPECT_EQ(now["trials_defined"], 72);
  EXPECT_EQ(now["blocks"], 3);
  // The library that was missing is there before the session is started.
  EXPECT_THAT(now["notices"].dump(), HasSubstr("the session continues without its streams"));
}

TEST_F(LiveBreaksTest, EscapeInTheParticipantsWindowStopsASessionWithoutAConsole) {
  const test::VirtualDisplay display(1280, 720);
  LiveCommand session(run({}, "--window"));
  const auto partial = folder_ / "out/S01.h5.partial";
  ASSERT_TRUE(session.reaches([&] {
    display.try_key("haptrial", test::VirtualDisplay::kEnter);  // to begin
    try {
      const record::SessionReader reader(partial);
      const std::uint64_t rows = reader.sample_count();
      return rows > 0 && reader.samples(rows - 1, 1)[0].stage == record::Stage::kRun;
    } catch (const std::exception&) {
      return false;
    }
  })) << session.errors();
  display.press_key("haptrial", 0xff1b);
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1) << "it goes on: the key was not heard";
  EXPECT_THAT(ended.errors, HasSubstr("S01.h5.partial"));
}

}  // namespace
}  // namespace haptrial
