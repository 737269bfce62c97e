// Plans and their logs: what is written comes back, and a chain shows every change.

#include "experiments/plan/plan_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/files/sha256.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::plan_log_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

StudyPlan a_plan() {
  StudyPlan plan;
  plan.name = "weights";
  plan.made_utc = "2026-11-20T09:30:00Z";
  plan.login = "anna";
  plan.program = "haptrial 0.2.0 (1a2b3c4d5e6f)";
  plan.definition_name = "weights.toml";
  plan.definition = "[design]\nparticipants = 12\n";
  plan.definition_sha256 = analysis::sha256_of(plan.definition);
  plan.groups = {{"first", 5}, {"second", 7}};
  plan.sessions = 2;
  plan.hypotheses = {"Grüße are \"felt\""};
  plan.exclusions = {"left early"};
  plan.stopping = "when it is over";
  plan.ends_early = "group sequential";
  plan.looks = {6, 9};
  plan.retain_until = "2036-12-31";
  return plan;
}

class PlanLogTest : public testing::Test {
 protected:
  PlanLogTest() { write_text(plan_, plan_json(a_plan())); }
  /// The log's lines, each with its end.
  std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::istringstream in(file_text(log_));
    for (std::string line; std::getline(in, line);) {
      all.push_back(line + "\n");
    }
    return all;
  }
  void write_lines(const std::vector<std::string>& lines) const {
    std::string text;
    for (const std::string& line : lines) {
      text += line;
    }
    write_text(log_, text);
  }

  test::TemporaryFolder folder_;
  fs::path plan_{folder_ / "weights.plan.json"};
  fs::path log_{folder_ / "weights.plan.log"};
};

TEST_F(PlanLogTest, APlanComesBackAsItWasWritten) {
  const StudyPlan read = read_study_plan(plan_);
  EXPECT_EQ(plan_json(read), plan_json(a_plan()));
  EXPECT_EQ(read.sha256, analysis::sha256_of(plan_json(a_plan())));
  EXPECT_EQ(read.participants(), 12);
  write_text(folder_ / "other.json", "{\"format\": 1}");
  EXPECT_THROW(read_study_plan(folder_ / "other.json"), InputError);
  write_text(folder_ / "other.json", "[plan]");
  EXPECT_THROW(read_study_plan(folder_ / "other.json"), InputError);
}

TEST_F(PlanLogTest, DifferencesNameWhatWasStated) {
  StudyPlan later = a_plan();
  later.made_utc = "2027-01-01T00:00:00Z";
  later.login = "ben";
  later.definition += "# a comment\n";
  later.definition_sha256 = analysis::sha256_of(later.definition);
  EXPECT_THAT(plan_differences(a_plan(), later), IsEmpty());
  later.definition = "[design]\nparticipants = 14\n";
  EXPECT_THAT(plan_differences(a_plan(), later), ElementsAre("design.participants was 12, is 14"));
  StudyPlan other = a_plan();
  other.program = "haptrial 0.3.0 (0)";
  other.power = {"0.9"};
  EXPECT_THAT(plan_differences(a_plan(), other),
              ElementsAre(HasSubstr("program was \"haptrial 0.2.0"), HasSubstr("power was []")));
}

TEST_F(PlanLogTest, TheChainHoldsWhileLinesAreAdded) {
  EXPECT_EQ(read_plan_log(plan_).head, analysis::sha256_of(plan_json(a_plan())));
  note_in_log(plan_, kAnalysed, "people=3 tests=a < b; c = d");
  note_in_log(plan_, kSessionClosed, "begun=2026 sha256=00\ntwo\tlines");
  const PlanLog log = read_plan_log(plan_);
  EXPECT_EQ(log.broken, "");
  ASSERT_EQ(log.entries.size(), 2u);
  EXPECT_THAT(log.entries[0].values("people"), ElementsAre("3"));
  EXPECT_THAT(log.entries[0].values("tests"), ElementsAre("a < b; c = d"));
  EXPECT_THAT(log.entries[1].values("sha256"), ElementsAre("00 two lines"));
  EXPECT_EQ(log.head, log.entries[1].link);
  EXPECT_EQ(plan_event(folder_.path()),
            "plan=" + analysis::sha256_of(plan_json(a_plan())) + " link=" + log.head);
}

TEST_F(PlanLogTest, SeveralMayAddAtOnce) {
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&] {
      for (int i = 0; i < 10; ++i) {
        note_in_log(plan_, kAnalysed, "people=1");
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const PlanLog log = read_plan_log(plan_);
  EXPECT_EQ(log.broken, "");
  EXPECT_EQ(log.entries.size(), 40u);
}

TEST_F(PlanLogTest, EveryChangeBreaksTheChain) {
  for (int i = 0; i < 4; ++i) {
    note_in_log(plan_, kAnalysed, "people=" + std::to_string(i));
  }
  const std::vector<std::string> whole = lines();
  ASSERT_EQ(whole.size(), 4u);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    auto changed = whole;
    changed[i].replace(changed[i].find("people="), 7, "People=");
    write_lines(changed);
    EXPECT_THAT(read_plan_log(plan_).broken,
                HasSubstr(i == 0 ? "first line" : "line " + std::to_string(i + 1)));
  }
  auto without = whole;
  without.erase(without.begin() + 1);
  write_lines(without);
  EXPECT_THAT(read_plan_log(plan_).broken, HasSubstr("line 2"));
  auto exchanged = whole;
  std::swap(exchanged[1], exchanged[2]);
  write_lines(exchanged);
  EXPECT_THAT(read_plan_log(plan_).broken, HasSubstr("line 2"));
  write_lines(whole);
  EXPECT_EQ(read_plan_log(plan_).broken, "");
  write_text(plan_, file_text(plan_) + " ");
  EXPECT_THAT(read_plan_log(plan_).broken, HasSubstr("the plan"));
}

TEST_F(PlanLogTest, ALineThatWasCutOffAsItWasWrittenIsNone) {
  note_in_log(plan_, kAnalysed, "people=1");
  note_in_log(plan_, kAnalysed, "people=2");
  const std::string whole = file_text(log_beside(plan_));
  const std::size_t second = whole.find('\n') + 1;
  for (const std::size_t left : {second + 1, second + 30, whole.size() - 1}) {
    write_text(log_beside(plan_), whole.substr(0, left));
    EXPECT_EQ(read_plan_log(plan_).broken, "") << left;
    note_in_log(plan_, kAnalysed, "people=3");
    const PlanLog log = read_plan_log(plan_);
    EXPECT_EQ(log.broken, "") << left;
    ASSERT_EQ(log.entries.size(), 2u) << left;
    EXPECT_EQ(log.entries[1].values("people"), std::vector<std::string>{"3"});
  }
}

TEST_F(PlanLogTest, APlanIsTakenToItsSessionsOnce) {
  const fs::path out = folder_ / "out";
  fs::create_directory(out);
  adopt_plan(folder_ / "unplanned.toml", out);
  EXPECT_FALSE(plan_in(out));
  adopt_plan(folder_ / "weights.toml", out);
  EXPECT_EQ(file_text(out / "weights.plan.json"), file_text(plan_));
  adopt_plan(folder_ / "weights.toml", out);
  write_text(plan_, plan_json(a_plan()) + "\n");
  EXPECT_THROW(adopt_plan(folder_ / "weights.toml", out), InputError);
  write_text(out / "second.plan.json", "{}");
  EXPECT_THROW(static_cast<void>(plan_in(out)), InputError);
}

TEST_F(PlanLogTest, TheDateUntilWhichDataIsKeptIsNamedOnceItIsOver) {
  EXPECT_EQ(retention_sentence(a_plan(), "2036-12-31"), "");
  EXPECT_THAT(retention_sentence(a_plan(), "2037-01-01"), HasSubstr("until 2036-12-31"));
  StudyPlan without = a_plan();
  without.retain_until = "";
  EXPECT_EQ(retention_sentence(without, "2099-01-01"), "");
}

}  // namespace
}  // namespace haptrial::experiments::plan_log_test
