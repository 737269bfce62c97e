// `haptrial start`: the checklist, the session behind it with its backup, and the emergency card.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/record/read/marked_trials.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::live_start_test {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::LiveCommand;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

class LiveStartTest : public testing::Test {
 protected:
  void write_study(const std::string& room = "") {
    fs::create_directory(folder_ / "disk");
    test::write_text(folder_ / "study.toml", test::brisk_text() + room);
  }
  std::string room() const {
    return "\n[room]\nbackup = \"" + (folder_ / "disk").string() + "\"\n";
  }
  std::string arguments(const std::string& more) const {
    return "start '" + (folder_ / "study.toml").string() + "' --out '" +
           (folder_ / "out").string() + "' --trials 1 " + more;
  }
  CommandResult start(const std::string& more) const {
    return run_command("haptrial " + arguments(more) + " < /dev/null");
  }
  /// The check of a name in what `start --check --json` printed.
  static nlohmann::json check_of(const CommandResult& result, const std::string& what) {
    const auto json = nlohmann::json::parse(result.output);
    for (const auto& check : json["checks"]) {
      if (check["what"] == what) {
        return check;
      }
    }
    return {};
  }

  test::TemporaryFolder folder_;
};

TEST_F(LiveStartTest, WithoutATerminalItSaysWhatToDo) {
  write_study();
  const CommandResult refused = start("");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("needs a terminal; start --check prints the checklist"));
  EXPECT_EQ(start("--json").status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(LiveStartTest, TheChecklistSaysWhoComesAndWhatIsMissing) {
  write_study(room());
  const CommandResult good = start("--check --json");
  ASSERT_EQ(good.status, 0) << good.output << good.errors;
  const auto json = nlohmann::json::parse(good.output);
  EXPECT_EQ(json["participant"], "P01");
  EXPECT_TRUE(json["ready"]);
  EXPECT_GE(json["minutes"], 1.0);
  EXPECT_EQ(check_of(good, "participant")["state"], "ready");
  EXPECT_EQ(check_of(good, "device")["state"], "ready");
  EXPECT_EQ(check_of(good, "consent")["state"], "limited") << "the study has no such page";
  EXPECT_EQ(check_of(good, "backup")["state"], "limited") << "the folders are on one disk";
  EXPECT_EQ(check_of(good, "room for files")["state"], "ready");
  EXPECT_EQ(check_of(start("--check --json --consent 2026-11-20"), "consent")["state"], "ready");

  fs::remove(folder_ / "disk");
  EXPECT_THAT(check_of(start("--check --json"), "backup")["found"].get<std::string>(),
              HasSubstr("is not there; plug in its disk"));
  fs::create_directory(folder_ / "out");
  test::write_text(folder_ / "out/P05.h5.partial", "");
  const CommandResult begun = start("--check --json --subject P05");
  EXPECT_EQ(begun.status, 1) << begun.output;
  EXPECT_FALSE(nlohmann::json::parse(begun.output)["ready"]);
  EXPECT_EQ(check_of(begun, "participant")["state"], "broken");
  EXPECT_EQ(start("--check --subject 'P 5'").status, 2) << "no identifier";
}

TEST_F(LiveStartTest, APedalThatIsNotThereIsSaidBeforeTheSession) {
  const fs::path pedal = folder_ / "pedal";
  test::write_text(folder_ / "study.toml", R"([experiment]
protocol = "trials"
name = "pedal"
[design]
participants = 1
[[stages]]
name = "wait"
until = { time = 1.0 }
[response]
question = "Now?"
choices = [{ value = "yes", pedal = 0.5 }, { value = "no", keys = ["N"] }]
[[blocks]]
name = "one"
trials = 1
[observer]
decides = "yes"
[pedal]
input = ")" + pedal.string() + R"("
axis = "ABS_GAS"
released = 0
pressed = 940
)");
  const std::string checked = "--check --json --device mouse --window";
  const nlohmann::json missing = check_of(start(checked), "pedal");
  EXPECT_EQ(missing["state"], "broken");
  EXPECT_THAT(missing["found"].get<std::string>(), HasSubstr("No such file"));

  ASSERT_EQ(::mkfifo(pedal.c_str(), 0600), 0);
  const int writer = ::open(pedal.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(writer, 0);
  EXPECT_EQ(check_of(start(checked), "pedal")["state"], "ready");
  ::close(writer);
}

TEST_F(LiveStartTest, AnInterruptDoesNotWaitForAnAnswer) {
  if (!LiveCommand::has_terminals()) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  write_study();
  LiveCommand session("run '" + (folder_ / "study.toml").string() + "' --out '" +
                          (folder_ / "out").string() + "' --subject P01 --pilot",
                      "", LiveCommand::Where::kTerminal);
  ASSERT_TRUE(session.reaches([&] {
    return session.output().find("Is it a pilot?") != std::string::npos;
  })) << session.output();
  session.press("\x03");
  const CommandResult ended = session.wait();
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.output, HasSubstr("interrupted; nothing was recorded"));
  EXPECT_FALSE(fs::exists(folder_ / "out/P01.h5.partial"));
}

TEST_F(LiveStartTest, AfterTheQuestionItRunsTheSessionAndBacksItUp) {
  if (!LiveCommand::has_terminals()) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  write_study(room());
  LiveCommand declined(arguments(""), "", LiveCommand::Where::kTerminal);
  ASSERT_TRUE(declined.reaches([&] {
    return declined.output().find("Begin the session of P01?") != std::string::npos;
  })) << declined.output();
  declined.press("n\r");
  EXPECT_EQ(declined.wait().status, 1);
  EXPECT_FALSE(fs::exists(folder_ / "out/P01.h5"));

  LiveCommand session(arguments(""), "", LiveCommand::Where::kTerminal);
  ASSERT_TRUE(session.reaches(
      [&] { return session.output().find("Begin the session") != std::string::npos; }));
  session.press("y\r");
  const CommandResult done = session.wait();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_THAT(done.output, HasSubstr("compared byte by byte"));
  EXPECT_THAT(done.output, HasSubstr("next: haptrial info"));
  const fs::path copy = folder_ / "disk/force_training/P01.h5";
  ASSERT_TRUE(fs::exists(copy)) << done.output;
  EXPECT_EQ(test::read_text(copy), test::read_text(folder_ / "out/P01.h5"));
}

TEST_F(LiveStartTest, ARunWhoseBackupFailsIsWholeAndSaysSo) {
  write_study();
  const CommandResult done = run_command(
      "haptrial run '" + (folder_ / "study.toml").string() + "' --subject P02 --trials 1 --out '" +
      (folder_ / "out").string() + "' --backup '" + (folder_ / "unplugged").string() + "'");
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.errors, HasSubstr("WARNING: THE SESSION HAS NO BACKUP"));
  EXPECT_THAT(done.errors, HasSubstr("is its disk plugged in?"));
  EXPECT_EQ(run_command("haptrial info '" + (folder_ / "out/P02.h5").string() + "'").status, 0);
  EXPECT_THAT(check_of(start("--check --json"), "duration")["found"].get<std::string>(),
              testing::ContainsRegex("; before, it took .* minutes .* in 1 session"));
  EXPECT_FALSE(fs::exists(folder_ / "unplugged"));
}

TEST_F(LiveStartTest, TheEmergencyCardIsFilledInFromDefinitionAndLabFile) {
  write_study();
  test::write_text(folder_ / "lab.toml",
                   "[room]\nbackup = \"/mnt/backup\"\ncontact = \"Lab office <2>\"\n"
                   "phone = \"0123 456\"\n");
  test::write_text(
      folder_ / "study.toml",
      test::brisk_text({{"max_force", "max_force = 5.0"}, {"force_limit", "force_limit = 5.0"}}) +
          "\n[lab]\nuse = \"lab.toml\"\n");
  const std::string file = "'" + (folder_ / "card.html").string() + "'";
  const CommandResult made = start("--device force-dimension --window --console --card " + file);
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string page = test::read_text(folder_ / "card.html");
  for (const char* words :
       {"Greatest force on the hand: 5 N", "Press button 0 of the force-dimension",
        "EMERGENCY STOP", "Escape", "power switch", "Lab office &lt;2&gt;", "0123 456",
        "/mnt/backup/force_training/ID.h5", "--device force-dimension --window --console",
        "--subject ID --resume"}) {
    EXPECT_THAT(page, HasSubstr(words));
  }
  EXPECT_THAT(page, Not(HasSubstr("http"))) << "it needs nothing else";
  EXPECT_EQ(start("--card " + file).status, 2) << "a card that is there stays";
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

/// The card is read when a hand is in danger: it names the force of each part that is driven.
TEST_F(LiveStartTest, TheCardNamesTheGreatestForceOfEachPartOfTheHandle) {
  test::write_text(folder_ / "study.toml", R"([experiment]
protocol = "trials"
name = "parts"
[design]
participants = 1
[envelope]
max_force = 2.0
[force_dimension]
max_grip_force = 3.0
[devices.stylus]
start = [0.0, 0.0, 0.0]
[devices.knob]
rotation_of = "stylus"
radius = 0.025
max_force = 0.08
handle_mass = 4e-5
[devices.pinch]
grip_of = "stylus"
max_force = 4.0
start = [0.03, 0.0, 0.0]
[[stages]]
name = "wait"
until = { time = 0.3 }
[response]
question = "Now?"
choices = [{ value = "yes" }, { value = "no" }]
[[blocks]]
name = "one"
trials = 1
[observer]
decides = "yes"
)");
  const auto card_of = [&](const std::string& name, const std::string& device) {
    const fs::path file = folder_ / (name + ".html");
    const CommandResult made =
        start("--device " + device + " --console --card '" + file.string() + "'");
    EXPECT_EQ(made.status, 0) << made.errors;
    return made.status == 0 ? test::read_text(file) : "";
  };
  EXPECT_THAT(card_of("virtual", "virtual"),
              HasSubstr("Greatest force on the hand: 2 N (stylus, tip) and 0.08 N·m (knob, "
                        "rotation) and 4 N (pinch, grip)."));
  EXPECT_THAT(card_of("weaker", "force-dimension"), HasSubstr("3 N (pinch, grip)"))
      << "the driver gives no more";
}

/// A pilot with other values, streams and a backup goes on with them, not with the definition's.
TEST_F(LiveStartTest, TheCardsLineToGoOnHasEveryOptionOfTheSession) {
  write_study();
  const std::string given =
      " --console --watch 127.0.0.1 --lsl-optional --pilot --set envelope.ramp_in=0.3 --seed 5";
  const fs::path file = folder_ / "card.html";
  const CommandResult made = start(given + " --backup '" + (folder_ / "disk").string() +
                                   "' --subject P01 --age-band 18-25 --consent yes "
                                   "--card '" +
                                   file.string() + "'");
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string page = test::read_text(file);
  const std::size_t begin = page.find("haptrial run ");
  ASSERT_NE(begin, std::string::npos);
  const std::string line = page.substr(begin, page.find("--resume", begin) - begin);
  for (const char* words :
       {" --console", " --watch 127.0.0.1", " --lsl-optional", " --pilot",
        " --set envelope.ramp_in=0.3", " --seed 5", " --backup ", " --trials 1"}) {
    EXPECT_THAT(line, HasSubstr(words));
  }
  for (const char* words : {"P01", "--age-band", "--consent", "--card", "--lsl "}) {
    EXPECT_THAT(line, Not(HasSubstr(words))) << "the next participant has another";
  }
}

TEST_F(LiveStartTest, AtATerminalTheCardNamesItsKeys) {
  if (!LiveCommand::has_terminals()) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  write_study();
  const std::string file = "'" + (folder_ / "card.html").string() + "'";
  LiveCommand made(arguments("--console --card " + file), "", LiveCommand::Where::kTerminal);
  EXPECT_EQ(made.wait().status, 0) << made.output();
  EXPECT_THAT(test::read_text(folder_ / "card.html"),
              HasSubstr("Press Escape in the terminal; Ctrl-C there also ends the session."));
}

TEST_F(LiveStartTest, AResumedSessionKeepsItsMarks) {
  if (!LiveCommand::has_terminals()) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  test::write_text(folder_ / "study.toml", test::attended_text());
  const std::string run = "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
                          (folder_ / "out").string() + "' --keyboard --console";
  {
    LiveCommand session(run, "", LiveCommand::Where::kTerminal);
    test::ConsolePerson person(session.line_after("console: "));
    ASSERT_TRUE(person.sees("instructions")) << session.output();
    session.press(" ");
    ASSERT_TRUE(person.sees("running", "run"));
    session.press("bhand slipped\r");
    session.press("ay");
    EXPECT_EQ(session.wait().status, 0);
  }
  ASSERT_TRUE(fs::exists(folder_ / "out/S01.h5.partial"));
  LiveCommand resumed(run + " --resume", "", LiveCommand::Where::kTerminal);
  test::ConsolePerson person(resumed.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << resumed.output();
  resumed.press("ae");
  EXPECT_EQ(resumed.wait().status, 0);
  const auto marks = record::marked_trials(record::SessionReader(folder_ / "out/S01.h5"));
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0].trial, 1);
  EXPECT_EQ(marks[0].reason, "hand slipped");
  EXPECT_GT(marks[0].time_ns, 0);
}

}  // namespace
}  // namespace haptrial::live_start_test
