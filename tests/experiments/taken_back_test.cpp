// Answers that the experimenter takes back: in a break, while the next trial runs, while the
// session is paused, and before the session is killed. What counts in the end is a staircase that
// never saw them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_facts.h"
#include "core/record/rows/trial_rows.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::experiments::taken_back_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

const char* const kStudy = R"([experiment]
protocol = "trials"
name = "taken_back"
[design]
participants = 2
break_after = 4
break_duration = 4.0
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 1.0 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "staircase"
variable = "level"
unit = "N"
range = [0.1, 3.0]
start = 1.0
up = 1
down = 1
steps = [0.1]
stop = { trials = 9 }
counts = "$answer == 1"
[observer]
decides = "yes"
criterion = 0.8
force_weber = 0.3
force_floor = 0.1
reaction = 0.1
[observer.actions]
feel = { do = "hold" }
)";

/// The staircase of what counts: each level follows from the one before and its answer.
void expect_staircase(const fs::path& file, int trials) {
  const record::SessionReader reader(file);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
  const std::vector<record::PassRow> passes = reader.passes();
  std::map<int, record::LevelRow> counted;
  for (const record::LevelRow& row : reader.rows<record::LevelRow>()) {
    const record::PassRow& pass = passes[static_cast<std::size_t>(row.pass)];
    if (pass.status == record::PassStatus::kCompleted) {
      EXPECT_TRUE(counted.emplace(pass.trial, row).second) << "trial " << pass.trial << " twice";
    }
  }
  ASSERT_THAT(counted, SizeIs(trials));
  double expected = 1.0;
  for (const auto& [trial, row] : counted) {
    EXPECT_NEAR(row.applied, expected, 1e-9) << "trial " << trial;
    ASSERT_TRUE(row.outcome == 0.0 || row.outcome == 1.0);
    expected += row.outcome == 1.0 ? -0.1 : 0.1;
  }
}

std::vector<std::string> texts_of(const fs::path& file, const std::string& kind) {
  std::vector<std::string> texts;
  for (const record::EventRow& event : record::SessionReader(file).events()) {
    if (event.kind == kind) {
      texts.push_back(event.text);
    }
  }
  return texts;
}

class TakenBackTest : public testing::Test {
 protected:
  TakenBackTest() { test::write_text(folder_ / "study.toml", kStudy); }
  std::string run(const std::string& more = "") const {
    return "run '" + (folder_ / "study.toml").string() +
           "' --subject S01 --device virtual --out '" + (folder_ / "out").string() +
           "' --console " + more;
  }
  /// Waits for a trial in which the answer before can be taken back.
  static void await(test::ConsolePerson& person, int trial, bool possible = true) {
    test::wait_until([&] {
      const nlohmann::json s = person.status();
      return s["trial"] == trial && s["state"] == "running" && s["can_take_back"] == possible;
    });
  }
  test::TemporaryFolder folder_;
  fs::path file_{folder_ / "out/S01.h5"};
};

TEST_F(TakenBackTest, TheProcedureGoesOnAsIfItHadNotBeenGiven) {
  test::LiveCommand session(run());
  test::ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  person.ask("start");
  await(person, 1, false);
  person.ask("take_back");  // there is nothing yet
  await(person, 3);
  person.ask("take_back");  // the answer to trial 2, while trial 3 runs
  ASSERT_TRUE(person.sees("break"));
  person.ask("take_back");  // that to trial 4
  await(person, 7);
  person.ask("pause");
  ASSERT_TRUE(person.sees("paused"));
  person.ask("take_back");  // that to trial 7
  person.ask("start");
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;

  expect_staircase(file_, 9);
  EXPECT_THAT(texts_of(file_, "taken_back"),
              testing::ElementsAre("trial 2: by the console", "trial 4: by the console",
                                   "trial 7: by the console"));
  EXPECT_THAT(texts_of(file_, "aborted"),
              testing::ElementsAre("trial 3: an answer was taken back"));
  // Their rows stay, and the first three passes of trials 2 and 3 are told apart by attempts.
  const record::SessionReader reader(file_);
  const auto rows = reader.rows<record::TakenBackRow>();
  ASSERT_THAT(rows, SizeIs(4));
  std::multiset<int> trials;
  for (const record::TakenBackRow& row : rows) {
    const record::PassRow pass = reader.passes()[static_cast<std::size_t>(row.pass)];
    EXPECT_EQ(pass.trial, row.trial);
    EXPECT_EQ(pass.attempt, 1);
    trials.insert(row.trial);
  }
  EXPECT_EQ(trials, (std::multiset<int>{2, 3, 4, 7}));

  const auto analysed = test::run_command("haptrial analyze '" + (folder_ / "out").string() + "'");
  EXPECT_EQ(analysed.status, 0) << analysed.errors;
  EXPECT_THAT(analysed.output, HasSubstr("Taken back by the experimenter, and presented again, "
                                         "which is what is analysed: 3 trials: S01, trial 2"));
}

TEST_F(TakenBackTest, AKilledSessionGoesOnInTheSameWay) {
  {
    test::LiveCommand session(run());
    test::ConsolePerson person(session.line_after("console: "));
    ASSERT_TRUE(person.sees("instructions"));
    person.ask("start");
    await(person, 3);
    person.ask("take_back");
    test::wait_until([&] {
      const nlohmann::json s = person.status();
      return s["trial"] == 2 && s["state"] == "running";
    });
    session.signal(SIGKILL);
    session.wait();
  }
  ASSERT_TRUE(fs::exists(file_.string() + ".partial"));
  test::LiveCommand session(run("--resume"));
  test::ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  person.ask("start");
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  expect_staircase(file_, 9);
  EXPECT_THAT(texts_of(file_, "taken_back"), testing::ElementsAre("trial 2: by the console"));
}

TEST_F(TakenBackTest, ATrialThatIsRepeatedAfterItsEndCountsOnce) {
  test::LiveCommand session(run("--trials 2"));
  test::ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions"));
  person.ask("start");
  await(person, 1, false);
  person.ask("pause");
  ASSERT_TRUE(person.sees("paused"));
  person.ask("repeat");
  person.ask("start");
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  expect_staircase(file_, 2);
  EXPECT_THAT(texts_of(file_, "taken_back"),
              testing::ElementsAre("trial 1: repeated after its end"));
}

}  // namespace
}  // namespace haptrial::experiments::taken_back_test
