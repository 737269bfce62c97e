// Ends of a session from outside: Ctrl-C in the terminal, SIGTERM, and a terminal whose window is
// closed; during a pass, a text and a break.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::ConsolePerson;
using test::LiveCommand;
using testing::HasSubstr;

enum class Interruption { kControlC, kTerminate, kCloseTerminal };
enum class Moment { kPass, kText, kBreak };

class LiveInterruptTest : public testing::TestWithParam<std::tuple<Interruption, Moment>> {
 protected:
  LiveInterruptTest() {
    test::write_text(folder_ / "study.toml",
                     test::attended_text({{"repetitions", "repetitions = 1"},
                                          {"break_after", "break_after = 1"},
                                          {"break_duration", "break_duration = 3600.0"}}));
  }
  void SetUp() override {
    if (way() != Interruption::kTerminate && !LiveCommand::has_terminals()) {
      GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
    }
  }
  static Interruption way() { return std::get<0>(GetParam()); }
  static Moment moment() { return std::get<1>(GetParam()); }

  std::string run(const std::string& more = "") const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' --console " + more;
  }
  static void come_to_the_moment(ConsolePerson& person) {
    ASSERT_TRUE(person.sees("instructions"));
    if (moment() == Moment::kText) {
      test::wait_until([&person] { return person.status()["ticks"] > 300; });
      return;
    }
    ASSERT_TRUE(person.ask("start"));
    ASSERT_TRUE(person.sees("running", "run"));
    if (moment() == Moment::kBreak) {
      ASSERT_TRUE(person.ask("skip"));
      ASSERT_TRUE(person.sees("break"));
    }
  }
  static void interrupt(LiveCommand& session) {
    switch (way()) {
      case Interruption::kControlC:
        session.press("\x03");
        break;
      case Interruption::kTerminate:
        session.signal(SIGTERM);
        session.signal(SIGTERM);  // as `timeout` tells the program and its group
        break;
      case Interruption::kCloseTerminal:
        session.hang_up();
        break;
    }
  }
  void expect_it_goes_on() {
    const fs::path partial = folder_ / "out/S01.h5.partial";
    const std::uint64_t rows = record::SessionReader(partial).sample_count();
    EXPECT_GT(rows, 0u);
    LiveCommand again(run("--resume"));
    ConsolePerson person(again.line_after("console: "));
    ASSERT_TRUE(again.reaches([&person] {
      const nlohmann::json now = person.status();
      return !now.is_null() && now["state"] == "instructions" && now["ticks"] > 0;
    })) << again.errors();
    ASSERT_TRUE(person.ask("end"));
    const CommandResult ended = again.wait();
    EXPECT_EQ(ended.status, 0) << ended.errors;
    const record::SessionReader reader(folder_ / "out/S01.h5");
    const record::Integrity integrity = record::check_session(reader);
    EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
    EXPECT_GT(reader.sample_count(), rows);
    EXPECT_FALSE(fs::exists(partial));
  }

  test::TemporaryFolder folder_;
};

TEST_P(LiveInterruptTest, EndsAtOnceAndCanBeGoneOnWith) {
  LiveCommand session(run(), "",
                      way() == Interruption::kTerminate ? LiveCommand::Where::kBackground
                                                        : LiveCommand::Where::kTerminal);
  ConsolePerson person(session.line_after("console: "));
  ASSERT_NO_FATAL_FAILURE(come_to_the_moment(person)) << session.errors();
  interrupt(session);
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1);
  if (way() != Interruption::kCloseTerminal) {  // there nobody reads it any more
    const std::string said = way() == Interruption::kTerminate ? ended.errors : ended.output;
    EXPECT_THAT(said, HasSubstr("haptrial: interrupted; what was recorded is in "));
    EXPECT_THAT(said, HasSubstr("S01.h5.partial"));
  }

  ASSERT_TRUE(fs::exists(folder_ / "out/S01.h5.partial"));
  const CommandResult info =
      test::run_command("haptrial info '" + (folder_ / "out/S01.h5.partial").string() + "'");
  EXPECT_EQ(info.status, 1) << "not complete";
  EXPECT_THAT(info.output, HasSubstr("interrupted at "));
  EXPECT_THAT(info.output, HasSubstr(" 0 gaps"));
  expect_it_goes_on();
}

const char* const kLongStage = R"([experiment]
protocol = "trials"
name = "wait"
[design]
participants = 2
[[stages]]
name = "wait"
until = { time = 5.0 }
[response]
question = "Felt?"
choices = [{ value = "yes" }, { value = "no" }]
[[blocks]]
name = "one"
trials = 1
[observer]
decides = "yes"
[analysis]
kind = "none"
)";

/// The lid of a laptop is closed in a trial, and opened again.
TEST(LiveSuspensionTest, TheTrialInWhichItHappensIsNamed) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "wait.toml", kLongStage);
  const std::string out = "'" + (folder / "out").string() + "'";
  LiveCommand session("run '" + (folder / "wait.toml").string() +
                      "' --subject S01 --device virtual --out " + out);
  session.line_after("recording ");
  ASSERT_TRUE(session.reaches([&] {
    try {
      return record::SessionReader(folder / "out/S01.h5.partial").sample_count() > 0;
    } catch (const std::exception&) {
      return false;  // it has no tick yet
    }
  })) << session.errors();
  session.signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  session.signal(SIGCONT);
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("notice: the loop was suspended in trial 1, "));
  std::vector<std::string> suspended;
  for (const record::EventRow& event : record::SessionReader(folder / "out/S01.h5").events()) {
    if (event.kind == "suspended") {
      suspended.push_back(event.text);
    }
  }
  ASSERT_EQ(suspended.size(), 1u);
  EXPECT_THAT(suspended[0], testing::StartsWith("trial 1, "));
  const CommandResult analysed = test::run_command("haptrial analyze " + out);
  EXPECT_THAT(analysed.output, HasSubstr("The loop was suspended"));
  EXPECT_THAT(analysed.output, HasSubstr("S01, " + suspended[0]));
}

std::string name_of(const testing::TestParamInfo<std::tuple<Interruption, Moment>>& info) {
  const char* const ways[] = {"ControlC", "Terminate", "CloseTerminal"};
  const char* const moments[] = {"Pass", "Text", "Break"};
  return std::string(ways[static_cast<int>(std::get<0>(info.param))]) + "During" +
         moments[static_cast<int>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(
    All, LiveInterruptTest,
    testing::Combine(testing::Values(Interruption::kControlC, Interruption::kTerminate,
                                     Interruption::kCloseTerminal),
                     testing::Values(Moment::kPass, Moment::kText, Moment::kBreak)),
    name_of);

}  // namespace
}  // namespace haptrial
