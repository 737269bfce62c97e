// Participants who come on several days: which file is whose, who they are, what is analysed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/files/csv.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

/// Steps of force, felt without noise: everybody says yes from their own criterion on.
const char* const kTwoDays = R"([experiment]
protocol = "trials"
name = "two_days"
[design]
participants = 3
sessions = 2
[design.session.1]
blocks = ["low", "high"]
[design.session.2]
blocks = ["high"]
[[blocks]]
name = "low"
[[blocks]]
name = "high"
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.4 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "constant"
variable = "level"
unit = "N"
levels = { from = 0.2, to = 2.0, count = 24, spacing = "log" }
repetitions = 1
counts = "$answer == 1"
[observer]
decides = "yes"
criterion = { median = 1.0, spread = 0.3 }
force_weber = 0.0
force_floor = 0.0
reaction = 0.05
[observer.actions]
feel = { do = "hold" }
)";

class SessionsTest : public testing::Test {
 protected:
  SessionsTest() { test::write_text(definition_, kTwoDays); }
  test::CommandResult haptrial(const std::string& arguments) const {
    return test::run_command("haptrial " + arguments);
  }
  std::string definition() const { return "'" + definition_.string() + "'"; }
  std::string out() const { return "'" + (folder_ / "out").string() + "'"; }
  fs::path file(const std::string& name) const { return folder_ / "out" / name; }

  test::TemporaryFolder folder_;
  fs::path definition_{folder_ / "two_days.toml"};
};

/// The lowest level that was answered with yes.
double threshold_of(const record::SessionReader& file) {
  std::map<std::int32_t, double> answer;
  for (const record::ResponseRow& row : file.responses()) {
    answer[row.pass] = row.value;
  }
  double lowest = 10.0;
  for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
    lowest = answer.at(row.pass) == 1.0 ? std::min(lowest, row.applied) : lowest;
  }
  return lowest;
}

std::vector<double> asked_in(const record::SessionReader& file) {
  std::vector<double> asked;
  for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
    asked.push_back(row.asked);
  }
  return asked;
}

TEST_F(SessionsTest, ADryRunHasEverySessionOfEveryPerson) {
  const auto done = haptrial("dry-run " + definition() + " --jobs 2 --out " + out());
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("6 sessions"));
  std::map<std::string, double> thresholds;
  for (const char* name : {"S01", "S02", "S03"}) {
    const record::SessionReader first(file(std::string(name) + "-session-1.h5"));
    const record::SessionReader second(file(std::string(name) + "-session-2.h5"));
    EXPECT_EQ(first.info().session, 1u);
    EXPECT_EQ(second.info().session, 2u);
    EXPECT_EQ(second.info().subject, name);
    EXPECT_EQ(first.passes().size(), 48u);
    EXPECT_EQ(second.passes().size(), 24u);
    // The same person: without noise the answers change at one level, on every day.
    EXPECT_EQ(threshold_of(first), threshold_of(second));
    thresholds[name] = threshold_of(first);
    // The levels come in another order on another day.
    std::vector<double> high = asked_in(first);
    high.erase(high.begin(), high.begin() + 24);
    EXPECT_NE(high, asked_in(second));
    for (const record::VariableRow& row : second.rows<record::VariableRow>()) {
      EXPECT_TRUE(row.name != "session" || row.value == 2.0);
    }
  }
  // Three persons: their criteria differ by more than a step of 10 %.
  EXPECT_NE(thresholds["S01"], thresholds["S02"]);
  EXPECT_NE(thresholds["S02"], thresholds["S03"]);
}

TEST_F(SessionsTest, OneSessionAloneIsTheOneOfTheWholeStudy) {
  ASSERT_EQ(haptrial("dry-run " + definition() + " --subjects 1 --out " + out()).status, 0);
  const auto alone = haptrial("dry-run " + definition() + " --subjects 1 --session 2 --out '" +
                              (folder_ / "alone").string() + "'");
  ASSERT_EQ(alone.status, 0) << alone.errors;
  EXPECT_FALSE(fs::exists(folder_ / "alone/S01-session-1.h5"));
  const record::SessionReader one(folder_ / "alone/S01-session-2.h5");
  EXPECT_EQ(asked_in(one), asked_in(record::SessionReader(file("S01-session-2.h5"))));
  const auto none = haptrial("dry-run " + definition() + " --session 3 --out '" +
                             (folder_ / "none").string() + "'");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("--session is 3; allowed: a whole number from 1 to 2"));
}

TEST_F(SessionsTest, TheAnalysisJoinsThemAndSaysWhatIsMissing) {
  ASSERT_EQ(haptrial("dry-run " + definition() + " --out " + out()).status, 0);
  const auto whole = haptrial("analyze " + out());
  ASSERT_EQ(whole.status, 0) << whole.errors;
  EXPECT_THAT(whole.output, Not(HasSubstr("has no session")));
  fs::remove(file("S03-session-2.h5"));
  const auto less = haptrial("analyze " + out());
  ASSERT_EQ(less.status, 0) << less.errors;
  EXPECT_THAT(less.output, HasSubstr("S03 has no session 2."));
  EXPECT_THAT(test::read_text(file("report.md")), HasSubstr("S03 has no session 2."));
  const auto table = analysis::CsvTable::load(file("trials.csv"));
  std::map<std::pair<std::string, double>, int> rows;
  const auto sessions = table.numbers(table.column("session"));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    ++rows[{std::string(table.text(row, table.column("participant"))), sessions[row]}];
  }
  EXPECT_EQ(rows.size(), 5u);
  EXPECT_EQ((rows[{"S01", 1.0}]), 48);
  EXPECT_EQ((rows[{"S01", 2.0}]), 24);
  EXPECT_EQ((rows[{"S03", 1.0}]), 48);
  const auto results = nlohmann::json::parse(test::read_text(file("results.json")));
  EXPECT_EQ(results.at("participants").size(), 3u);
  EXPECT_EQ(results.at("participants")[0].at("sessions"), 2);
}

TEST_F(SessionsTest, TablesForOtherProgramsHaveTheNumber) {
  ASSERT_EQ(haptrial("dry-run " + definition() + " --subjects 1 --out " + out()).status, 0);
  fs::remove(file("S01-session-1.h5"));  // the second is the second all the same
  const auto done = haptrial("export --csv '" + (folder_ / "csv").string() + "' " + out());
  ASSERT_EQ(done.status, 0) << done.errors;
  for (const char* name : {"sessions.csv", "trials.csv", "levels.csv"}) {
    const auto table = analysis::CsvTable::load(folder_ / "csv" / name);
    EXPECT_THAT(table.numbers(table.column("session")), Each(2.0)) << name;
  }
}

TEST_F(SessionsTest, RunTakesTheFirstSessionThatIsLeft) {
  const std::string run = "run " + definition() + " --trials 1 --out " + out();
  const auto first = haptrial(run + " --subject P01");
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_THAT(first.output, HasSubstr("next of P01: session 1 of 2"));
  const auto second = haptrial(run + " --subject P01");
  ASSERT_EQ(second.status, 0) << second.errors;
  EXPECT_THAT(second.output, HasSubstr("P01-session-2.h5"));
  EXPECT_EQ(record::SessionReader(file("P01-session-2.h5")).info().session, 2u);
  const auto third = haptrial(run + " --subject P01");
  EXPECT_EQ(third.status, 2);
  EXPECT_THAT(third.errors, HasSubstr("P01 has had 2 sessions"));
  const auto again = haptrial(run + " --subject P01 --session 2");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("already has a session here"));
}

}  // namespace
}  // namespace haptrial::experiments
