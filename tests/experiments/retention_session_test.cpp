// A study of force training over groups and sessions (docs/worked/teaching/force_retention.toml):
// pre-test, training, post-test, retention, from its rehearsal to its report. All simulated.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/session_types.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::retention_session_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

const fs::path kStudy =
    fs::path(HAPTRIAL_SOURCE_DIR) / "docs" / "worked" / "teaching" / "force_retention.toml";

/// The study with fewer patterns, along a faster path, and two participants in each group.
std::string short_study() {
  std::string text = test::read_text(kStudy);
  text = test::replaced(text, "participants = 12", "participants = 6");
  text = test::replaced(text, "trials = 12 ", "trials = 6 ");
  text = test::replaced(text, "seen = 4\nseen-and-felt = 4\ncontrol = 4",
                        "seen = 2\nseen-and-felt = 2\ncontrol = 2");
  return test::replaced(text, "speed = 0.016 ", "speed = 0.032 ");
}

struct Score {
  std::string subject, group, session;
  double value{0.0};
};

std::vector<Score> scores_of(const std::string& text) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  EXPECT_TRUE(line.starts_with(
      "subject,group,session_number,session_name,trial,block,repetition,condition,score,"))
      << line;
  std::vector<Score> all;
  while (std::getline(in, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) {
      fields.push_back(field);
    }
    all.push_back({fields.at(0), fields.at(1), fields.at(3), std::stod(fields.at(8))});
  }
  return all;
}

class RetentionSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::write_text(*folder_ / "study.toml", short_study());
    good("dry-run study.toml --out out");
    lines_ = good("analyze out");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static test::CommandResult run(const std::string& arguments) {
    return test::run_command("cd '" + folder_->path().string() + "'; haptrial " + arguments);
  }
  static std::string good(const std::string& arguments) {
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.errors;
    return result.output + result.errors;
  }
  static std::string refused(const std::string& arguments) {
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    return result.errors;
  }
  static fs::path session(int participant, int number, const char* folder = "out") {
    return fs::path(*folder_ / folder) /
           ("S0" + std::to_string(participant) + "-session-" + std::to_string(number) + ".h5");
  }
  /// The ideal force over a block, tick by tick.
  static std::vector<double> pattern(int participant, int number, int block) {
    std::vector<double> force;
    for (const auto& row : record::SessionReader(session(participant, number)).stimuli()) {
      if (row.block == block) {
        force.push_back(row.force);
      }
    }
    return force;
  }
  /// The mean of a group's participants' means in a session, from the table of scores.
  static double mean(const std::string& group, const std::string& session) {
    std::map<std::string, std::pair<double, int>> sums;
    for (const Score& each : scores_of(test::read_text(*folder_ / "out" / "session_scores.csv"))) {
      if (each.group == group && each.session == session) {
        sums[each.subject].first += each.value;
        ++sums[each.subject].second;
      }
    }
    double sum = 0.0;
    for (const auto& [subject, of] : sums) {
      sum += of.first / of.second;
    }
    return sum / static_cast<double>(sums.size());
  }
  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::string lines_;  // of analyze
};
std::unique_ptr<test::TemporaryFolder> RetentionSessionTest::folder_;
std::string RetentionSessionTest::lines_;

TEST_F(RetentionSessionTest, EverybodyComesToTheirSessionsAndTestsHaveNoTraining) {
  for (int participant = 1; participant <= 6; ++participant) {
    for (int number = 1; number <= 4; ++number) {
      const bool training = number == 2;
      const fs::path file = session(participant, number);
      ASSERT_EQ(fs::exists(file), !(participant > 4 && training)) << file;
      if (!fs::exists(file)) {
        continue;
      }
      std::map<record::Phase, int> passes;
      for (const record::PassRow& pass : record::SessionReader(file).passes()) {
        ++passes[pass.phase];
      }
      EXPECT_EQ(passes[record::Phase::kTest], 6) << file;
      EXPECT_EQ(passes[record::Phase::kTraining], training ? 6 : 0) << file;
    }
  }
}

TEST_F(RetentionSessionTest, AGroupHasItsConditionsAndOthersHaveAll) {
  const auto conditions = [](int participant, int number) {
    std::set<std::string> all;
    for (const auto& pass : record::SessionReader(session(participant, number)).passes()) {
      all.insert(pass.condition);
    }
    return all;
  };
  for (const int number : {1, 2, 3, 4}) {
    EXPECT_THAT(conditions(1, number), ElementsAre("visual"));
    EXPECT_THAT(conditions(4, number), ElementsAre("visuohaptic"));
  }
  EXPECT_THAT(conditions(5, 1), ElementsAre("visual", "visuohaptic"));
}

TEST_F(RetentionSessionTest, ThePatternsOfAParticipantAreThoseOfTheTraining) {
  for (const int block : {1, 2}) {
    const std::vector<double> taught = pattern(1, 2, block);
    ASSERT_GT(taught.size(), 100u);
    for (const int number : {1, 3, 4}) {
      EXPECT_EQ(pattern(1, number, block), taught);
    }
    EXPECT_NE(pattern(2, 2, block), taught);
  }
  EXPECT_NE(pattern(1, 2, 1), pattern(1, 2, 2));
}

/// Trained participants recall in later sessions, the others do not.
TEST_F(RetentionSessionTest, VirtualParticipantsKeepWhatTheyWereTaught) {
  for (const char* group : {"seen", "seen-and-felt"}) {
    const double before = mean(group, "pre-test");
    EXPECT_LT(mean(group, "post-test"), 0.7 * before) << group;
    EXPECT_LT(mean(group, "retention"), 0.7 * before) << group;
  }
  const double before = mean("control", "pre-test");
  EXPECT_NEAR(mean("control", "retention"), before, 0.1 * before);
}

TEST_F(RetentionSessionTest, TheReportComparesChangesBetweenGroups) {
  EXPECT_THAT(lines_, HasSubstr("change of recall error: Planned, seen-and-felt, retention"));
  const auto json = nlohmann::json::parse(test::read_text(*folder_ / "out" / "statistics.json"));
  const auto& learned = json.at("learning_from_session_to_session");
  EXPECT_EQ(learned.at("baseline"), "pre-test");
  EXPECT_EQ(learned.at("tests"), (std::vector<std::string>{"post-test", "retention"}));
  const auto& outcome = learned.at("outcomes").at(0);
  int found = 0;
  for (const auto& cell : outcome.at("means")) {
    const std::string group = cell.at("group"), number = cell.at("session");
    if (cell.at("mean").contains("mean")) {
      EXPECT_NEAR(cell.at("mean").at("mean").get<double>(), mean(group, number), 1e-9)
          << group << " " << number;
      ++found;
    }
  }
  EXPECT_EQ(found, 11) << "three groups in four sessions, but for the control group's training";
  ASSERT_EQ(outcome.at("changes").at("planned").size(), 2u);
  const std::string report = test::read_text(*folder_ / "out" / "report.md");
  EXPECT_THAT(report, AllOf(HasSubstr("## Learning from session to session"),
                            HasSubstr("change to retention"), HasSubstr("learning-score")));
  // The conditions are compared right after training alone: two groups of two people, six trials.
  EXPECT_EQ(json.at("trials"), 24);
  EXPECT_EQ(json.at("participants"), 4);
  const auto& judged = json.at("quality").at("participants");
  ASSERT_EQ(judged.size(), 4u) << "the control group is not judged before a training";
  for (const auto& participant : judged) {
    EXPECT_EQ(participant.at("trials"), 18) << "one training and two tests of six trials after it";
  }
}

TEST_F(RetentionSessionTest, ASessionOfOneAloneIsTheSameAsInTheWholeRehearsal) {
  good("dry-run study.toml --subjects 3 --session 4 --out alone");
  const auto applied = [](const fs::path& file) {
    std::vector<double> force;
    const record::SessionReader reader(file);
    for (const record::Sample& sample : reader.samples(0, 20000)) {
      force.push_back(sample.applied_force);
    }
    return force;
  };
  const auto whole = applied(session(3, 4));
  EXPECT_GT(whole.size(), 1000u);
  EXPECT_EQ(applied(session(3, 4, "alone")), whole);
}

TEST_F(RetentionSessionTest, TheRosterKnowsWhoComesToWhichSession) {
  fs::create_directory(*folder_ / "begun");
  for (const int participant : {3, 5}) {
    fs::copy_file(session(participant, 1), session(participant, 1, "begun"));
  }
  EXPECT_THAT(good("roster study.toml begun"),
              AllOf(HasSubstr("S03 (group seen-and-felt), session 2 of 4"),
                    HasSubstr("S05 (group control), session 3 of 4")));
  EXPECT_THAT(refused("run study.toml --subject S05 --session 2 --out people"),
              HasSubstr("session training is for seen, seen-and-felt, and S05 is of control"));
}

TEST_F(RetentionSessionTest, AMissingSessionIsNamed) {
  good("dry-run study.toml --subjects 3 --session 2 --out trainings");
  EXPECT_THAT(good("analyze trainings"),
              AllOf(HasSubstr("S01 has no session pre-test."), HasSubstr("3 of 6 planned")));
  good("dry-run study.toml --subjects 3 --session 1 --out tests");
  EXPECT_THAT(refused("analyze tests"), HasSubstr("no session that trains"));
}

/// The analysis knows the group by the identifier, a session by the number.
TEST_F(RetentionSessionTest, ANumberOfAnotherGroupIsRefused) {
  const std::string text = refused("run study.toml --subject P01 --participant 3 --session 2");
  EXPECT_THAT(text, HasSubstr("--participant is 3, a number of seen-and-felt, but P01 is of seen"));
  EXPECT_THAT(text, HasSubstr("allowed: --participant with a number of seen"));
}

TEST_F(RetentionSessionTest, GroupsOfOneHaveMeansWithoutIntervals) {
  std::string text = test::replaced(short_study(), "participants = 6", "participants = 3");
  text = test::replaced(text, "seen = 2\nseen-and-felt = 2\ncontrol = 2",
                        "seen = 1\nseen-and-felt = 1\ncontrol = 1");
  test::write_text(*folder_ / "ones.toml", text);
  good("dry-run ones.toml --out ones");
  good("analyze ones");
  const std::string report = test::read_text(*folder_ / "ones" / "report.md");
  EXPECT_THAT(report, HasSubstr("](learning-score.svg)"));
  EXPECT_THAT(report,
              testing::ContainsRegex("\n\\| seen \\| [0-9.]+ \\| [0-9.]+ \\| [0-9.]+ \\| "));
}

TEST_F(RetentionSessionTest, AMistakeInThePlanGetsASentence) {
  const auto refusal = [](const std::string& what, const std::string& by) {
    test::write_text(*folder_ / "bad.toml", test::replaced(short_study(), what, by));
    return refused("validate bad.toml");
  };
  EXPECT_THAT(refusal("seen = [\"visual\"]", "seen = [\"haptic\"]"),
              AllOf(HasSubstr("design.group_conditions.seen"), HasSubstr("visual, visuohaptic")));
  EXPECT_THAT(refusal("seen = [\"visual\"]", "sen = [\"visual\"]"),
              HasSubstr("groups: seen, seen-and-felt, control"));
  EXPECT_THAT(refusal("name = \"retention\" ", "trials = 9\nname = \"retention\" "),
              AllOf(HasSubstr("design.session.4.trials"), HasSubstr("a multiple of 6")));
  EXPECT_THAT(refusal("baseline = \"pre-test\"", "baseline = \"before\""),
              HasSubstr("a session: pre-test, training, post-test, retention"));
  EXPECT_THAT(refusal("outcomes = [\"score\"]", "outcomes = [\"scores\"]"),
              HasSubstr("did you mean score?"));
  EXPECT_THAT(refusal("sessions = 4 ", "sessions = 5 "), HasSubstr("says nothing of session 5"));
  EXPECT_THAT(refusal("control = 2", "control = 3"), HasSubstr("has 7 participants in all"));
}

}  // namespace
}  // namespace haptrial::experiments::retention_session_test
