// `haptrial run --keyboard` in a terminal: the keys steer a real session, and the terminal is as
// before when it has ended.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::ConsolePerson;
using test::LiveCommand;
using testing::HasSubstr;

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
  EXPECT_THAT(done, testing::ElementsAre(
                        "start: by the terminal", testing::MatchesRegex("note: (trial 1: )?hand rested"),
                        "aborted: trial 1: to be repeated", "emergency_stop: by the terminal",
                        HasSubstr("trial 1: emergency stop"), "clear: by the terminal"));
}

}  // namespace
}  // namespace haptrial
