// Rights of the participant's own keyboard in a session, and the start of one without an
// experimenter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/file_text.h"
#include "core/record/read/integrity.h"
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
using test::VirtualDisplay;
using testing::ElementsAre;
using testing::HasSubstr;

class LiveWindowKeysTest : public testing::Test {
 protected:
  void SetUp() override { display_.emplace(640, 480); }
  std::string run(const std::string& more, const std::string& screen = "") const {
    test::write_text(folder_ / "study.toml",
                     test::attended_text({{"full_screen", "full_screen = false"},
                                          {"width", "width = 600"},
                                          {"height", "height = 440"},
                                          {"photodiode", "photodiode = \"off\"" + screen}}));
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' --window " + more;
  }
  void press(unsigned long key) const { display_->press_key("haptrial", key); }
  std::vector<std::string> events(const std::string& file) const {
    std::vector<std::string> told;
    for (const record::EventRow& event : record::SessionReader(folder_ / file).events()) {
      if (event.kind == "start" || event.kind == "clear" || event.kind == "emergency_stop") {
        told.push_back(event.kind + " " + event.text);
      }
    }
    return told;
  }
  int passes() const {
    try {
      const record::SessionReader reader(folder_ / "out/S01.h5.partial");
      const std::uint64_t rows = reader.sample_count();
      return rows > 0 ? reader.samples(rows - 1, 1)[0].pass + 1 : 0;
    } catch (const std::exception&) {
      return 0;
    }
  }

  test::TemporaryFolder folder_;
  std::optional<VirtualDisplay> display_;
};

TEST_F(LiveWindowKeysTest, StopTheSessionAndDoNothingElse) {
  LiveCommand session(run("--console"));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  EXPECT_THAT(person.status()["screen"].get<std::string>(), HasSubstr("A square in the"));
  press(' ');
  press(VirtualDisplay::kEnter);
  EXPECT_FALSE(person.sees_within(0.5, "running")) << "the experimenter starts";
  ASSERT_TRUE(person.ask("start")) << session.errors();
  ASSERT_TRUE(person.sees("running", "run")) << session.errors();
  for (const char key : {'s', 'r', 'p'}) {
    press(static_cast<unsigned long>(key));
  }
  EXPECT_FALSE(person.sees_within(0.5, "paused"));
  EXPECT_EQ(person.status()["aborted_passes"], 0);
  press(VirtualDisplay::kEscape);  // anybody may stop
  ASSERT_TRUE(person.sees("stopped")) << session.errors();
  EXPECT_THAT(person.status()["screen"].get<std::string>(), HasSubstr("The forces are off"));
  press('c');
  press(' ');
  EXPECT_FALSE(person.sees_within(0.5, "paused"));
  EXPECT_EQ(person.status()["state"], "stopped");
  ASSERT_TRUE(person.ask("clear")) << session.errors();
  ASSERT_TRUE(person.sees("paused")) << session.errors();
  EXPECT_THAT(person.status()["screen"].get<std::string>(), HasSubstr("pause"));
  ASSERT_TRUE(person.ask("start")) << session.errors();
  ASSERT_TRUE(person.sees("running", "run")) << session.errors();
  EXPECT_EQ(person.seen()["screen"], "") << "the trial is shown again";
  display_->ask_to_close("haptrial");  // no way out of a session either, but a stop
  ASSERT_TRUE(person.sees("stopped")) << session.errors();
  ASSERT_TRUE(person.ask("abort")) << session.errors();
  session.wait();
  const bool closed = std::filesystem::exists(folder_ / "out/S01.h5");
  EXPECT_THAT(
      events(closed ? "out/S01.h5" : "out/S01.h5.partial"),
      ElementsAre("start by the console", "emergency_stop by the window", "clear by the console",
                  "start by the console", "emergency_stop by the window"));
}

TEST_F(LiveWindowKeysTest, SteerWhereTheDefinitionSaysSo) {
  LiveCommand session(run("--console", "\nparticipant_steers = true"));
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  press(' ');
  ASSERT_TRUE(person.sees("running", "run")) << session.errors();
  press(VirtualDisplay::kEscape);
  ASSERT_TRUE(person.sees("stopped")) << session.errors();
  press('c');
  ASSERT_TRUE(person.sees("paused")) << session.errors();
  ASSERT_TRUE(person.ask("abort")) << session.errors();
  session.wait();
  const bool closed = std::filesystem::exists(folder_ / "out/S01.h5");
  EXPECT_THAT(
      events(closed ? "out/S01.h5" : "out/S01.h5.partial"),
      ElementsAre("start by the window", "emergency_stop by the window", "clear by the window"));
}

TEST_F(LiveWindowKeysTest, DoNotLeaveAPageBeforeItsVideoIsOver) {
  const CommandResult made =
      test::run_command("ffmpeg -loglevel error -f lavfi -i testsrc=d=1.6:s=320x240 '" +
                        (folder_ / "intro.mp4").string() + "'");
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string command = run("--console");
  test::write_text(folder_ / "study.toml",
                   file_text(folder_ / "study.toml") +
                       "[pages]\nbefore = [\"intro\"]\n[pages.intro]\n"
                       "text = \"This is what you do.\"\nvideo = \"intro.mp4\"\n");
  LiveCommand session(command);
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("page")) << session.errors();
  EXPECT_TRUE(session.reaches([&] {
    display_->try_key("haptrial", VirtualDisplay::kEnter);
    return person.status()["state"] != "page";
  })) << session.errors();
  ASSERT_TRUE(person.ask("abort"));
  session.wait();
  std::vector<std::string> told;
  for (const auto& event : record::SessionReader(folder_ / "out/S01.h5.partial").events()) {
    if (event.kind == "video") {
      told.push_back(event.text);
    }
  }
  ASSERT_EQ(told.size(), 2u);
  EXPECT_THAT(told[0], testing::MatchesRegex("intro.mp4: sha256=[0-9a-f]+"));
  EXPECT_EQ(told[1], "intro.mp4: 1.6 of 1.6 s were shown") << "though Enter was pressed all along";
}

TEST_F(LiveWindowKeysTest, BeginASessionWithoutAnExperimenter) {
  LiveCommand session(run(""));
  test::wait_until([this] { return std::filesystem::exists(folder_ / "out/S01.h5.partial"); });
  EXPECT_FALSE(test::happens_within(2.0, [this] { return passes() > 0; })) << "nobody said so";
  EXPECT_TRUE(session.reaches([this] {
    display_->try_key("haptrial", VirtualDisplay::kEnter);
    return passes() > 0;
  })) << session.errors();
  EXPECT_THAT(events("out/S01.h5.partial"), ElementsAre("start by the window"));
  press(VirtualDisplay::kEscape);
  EXPECT_EQ(session.wait().status, 1);
}

}  // namespace

// `haptrial run --keyboard` in a terminal: the keys steer a real session, and the terminal is as
// before when it has ended.

namespace {

TEST(LiveKeyboardTest, KeysSteerTheSessionAndTheTerminalIsPutBack) {
  if (!LiveCommand::has_terminals()) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", test::attended_text());
  LiveCommand session("run '" + (folder / "study.toml").string() + "' --subject S01 --out '" +
                          (folder / "out").string() + "' --keyboard --console",
                      "", LiveCommand::Where::kTerminal);
  ConsolePerson person(session.line_after("console: "));  // to see, not to ask
  ASSERT_TRUE(person.sees("instructions")) << session.output();
  EXPECT_THAT(session.output(), HasSubstr("Escape EMERGENCY STOP"));
  EXPECT_FALSE(session.takes_lines()) << "single keys";

  session.press(" ");
  ASSERT_TRUE(person.sees("running", "run"));
  session.press("nhand rested\r");
  session.press("r");
  test::wait_until([&] { return person.status()["aborted_passes"] == 1; });
  ASSERT_TRUE(person.sees("running", "run"));
  session.press("\x1b");
  ASSERT_TRUE(person.sees("stopped"));
  EXPECT_EQ(person.status()["applied_force"], 0.0);
  session.press(" ");  // starts nothing
  EXPECT_FALSE(person.sees_within(0.4, "running"));
  session.press("c");
  session.press("ax");  // not aborted
  test::wait_until([&] { return session.output().ends_with("not aborted\r\n"); });
  session.press("ae");
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 0) << ended.output;
  EXPECT_TRUE(session.takes_lines()) << "as before";
  EXPECT_THAT(ended.output, HasSubstr("2 passes aborted"));

  const record::SessionReader reader(folder / "out/S01.h5");
  EXPECT_TRUE(record::check_session(reader).ok);
  std::vector<std::string> done;
  for (const record::EventRow& event : reader.events()) {
    if (event.kind == "note" || event.kind == "emergency_stop" || event.kind == "aborted" ||
        event.kind == "start" || event.kind == "clear") {
      done.push_back(event.kind + ": " + event.text);
    }
  }
  EXPECT_THAT(done,
              testing::ElementsAre(
                  "start: by the terminal", testing::MatchesRegex("note: (trial 1: )?hand rested"),
                  "aborted: trial 1: to be repeated", "emergency_stop: by the terminal",
                  HasSubstr("trial 1: emergency stop"), "clear: by the terminal"));
}

}  // namespace
}  // namespace haptrial
