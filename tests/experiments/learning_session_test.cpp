// A study of learning in drillings (docs/worked/teaching) over groups and sessions, from its
// rehearsal to its report. All simulated.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/partner_rows.h"
#include "experiments/studies/experiment.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::learning_session_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const fs::path kStudy =
    fs::path(HAPTRIAL_SOURCE_DIR) / "docs" / "worked" / "teaching" / "learning_study.toml";

/// The study with a few seconds on a coarse bone, and two participants in each group.
std::string short_study() {
  std::string text = test::read_text(kStudy);
  text = test::replaced(text, "time_limit = 500.0", "time_limit = 4.0");
  text = test::replaced(text, "seed = 1 ", "spacing = 0.0012\nseed = 1 ");
  text = test::replaced(text, "card = true", "card = false");
  text = test::replaced(text, "vibration_gain = 1.0", "vibration_gain = 0.0");
  text = test::replaced(text, "participants = 16", "participants = 8");
  return test::replaced(text, "alone = 4\nhints = 4\nled = 4\ncontrol = 4",
                        "alone = 2\nhints = 2\nled = 2\ncontrol = 2");
}

using Row = std::map<std::string, std::string>;

/// A table without quotes, by the names of its columns.
std::vector<Row> table(const std::string& text) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) {
      fields.push_back(field);
    }
    return fields;
  };
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = split(line);
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      row[names.at(i)] = fields[i];
    }
  }
  return rows;
}

class LearningSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::write_text(*folder_ / "study.toml", short_study());
    test::write_text(*folder_ / "expert.toml",
                     test::replaced(short_study(), "led_in = [\"led\"]", "led_in = \"all\""));
    good("dry-run expert.toml --subjects 1 --session 1 --out expert");
    good("dry-run study.toml --tutor expert/S01-session-1.h5:1 --out out");
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
  static fs::path session(int participant, int number) {
    return fs::path(*folder_ / "out") /
           ("S0" + std::to_string(participant) + "-session-" + std::to_string(number) + ".h5");
  }
  static std::vector<std::string> conditions(int participant, int number) {
    std::vector<std::string> all;
    for (const record::PassRow& pass :
         record::SessionReader(session(participant, number)).passes()) {
      all.push_back(pass.condition);
    }
    return all;
  }
  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> LearningSessionTest::folder_;

TEST_F(LearningSessionTest, EverybodyComesToTheirSessionsAndGetsWhatTheirGroupIsGiven) {
  for (int participant = 1; participant <= 8; ++participant) {
    const bool control = participant > 6;
    for (int number = 1; number <= 5; ++number) {
      const bool training = number == 2 || number == 3;
      EXPECT_EQ(fs::exists(session(participant, number)), !(control && training))
          << participant << " " << number;
    }
    EXPECT_THAT(conditions(participant, 1), ElementsAre("hints off, tutor off"));
    EXPECT_THAT(conditions(participant, 4), ElementsAre("hints off, tutor off"));
  }
  EXPECT_THAT(conditions(1, 2), ElementsAre("hints off, tutor off", "hints off, tutor off"));
  EXPECT_THAT(conditions(3, 2), ElementsAre("hints on, tutor off", "hints on, tutor off"));
  EXPECT_THAT(conditions(6, 3), ElementsAre("hints off, tutor on", "hints off, tutor on"));
}

TEST_F(LearningSessionTest, TheTutorLeadsItsGroupInTrainingsAlone) {
  const auto led = [](int participant, int number) {
    return record::SessionReader(session(participant, number)).rows<record::TutoringRow>().size();
  };
  EXPECT_GT(led(5, 2), 1000u);
  EXPECT_EQ(led(5, 1), 0u);
  EXPECT_EQ(led(5, 4), 0u);
  EXPECT_EQ(led(1, 2), 0u);
}

TEST_F(LearningSessionTest, ASessionOfOneAloneIsTheSameAsInTheWholeRehearsal) {
  good("dry-run study.toml --subjects 3 --session 2 --out alone");
  const auto bones = [](const fs::path& file) {
    std::vector<std::uint64_t> checksums;
    for (const record::ProcedureRow& row :
         record::SessionReader(file).rows<record::ProcedureRow>()) {
      checksums.push_back(row.checksum);
    }
    return checksums;
  };
  const auto whole = bones(session(3, 2));
  EXPECT_EQ(whole.size(), 2u);
  EXPECT_EQ(bones(fs::path(*folder_ / "alone") / "S03-session-2.h5"), whole);
}

TEST_F(LearningSessionTest, TheRosterKnowsWhoComesToWhichSession) {
  good("roster study.toml out --json roster.json");
  const auto roster = nlohmann::json::parse(test::read_text(*folder_ / "roster.json"));
  EXPECT_TRUE(roster.at("next").empty());
  for (const auto& group : roster.at("groups")) {
    EXPECT_EQ(group.at("finished"), 2) << group;
  }
  fs::create_directory(*folder_ / "begun");
  for (const char* subject : {"S03", "S07"}) {
    const std::string name = std::string(subject) + "-session-1.h5";
    fs::copy_file(fs::path(*folder_ / "out") / name, fs::path(*folder_ / "begun") / name);
  }
  EXPECT_THAT(good("roster study.toml begun"),
              AllOf(HasSubstr("S03 (group hints), session 2 of 5"),
                    HasSubstr("S07 (group control), session 4 of 5")));
  fs::create_directory(*folder_ / "to_lead");
  fs::copy_file(session(5, 1), fs::path(*folder_ / "to_lead") / "S05-session-1.h5");
  EXPECT_THAT(good("roster study.toml to_lead"),
              HasSubstr("--subject S05 --session 2 --tutor FILE:TRIAL --out to_lead"));
}

TEST_F(LearningSessionTest, RunRefusesASessionThatIsNotForTheGroup) {
  EXPECT_THAT(refused("run study.toml --subject P08 --session 2 --out people"),
              HasSubstr("session training is for alone, hints, led, and P08 is of control"));
  EXPECT_THAT(refused("run study.toml --subject P05 --session 2 --out people"),
              HasSubstr("a tutor leads P05 in session training (tutoring.led_in); add --tutor"));
  EXPECT_FALSE(fs::exists(*folder_ / "people"));
}

TEST_F(LearningSessionTest, TheReportComparesChangesBetweenGroups) {
  const std::string lines = good("analyze out");
  EXPECT_THAT(lines, HasSubstr("change of planned cavity removed: Planned, hints"));
  const std::string report = test::read_text(*folder_ / "out" / "report.md");
  EXPECT_THAT(report,
              AllOf(HasSubstr("# Learning in drillings"), HasSubstr("## Learning from session"),
                    HasSubstr("change to post-test"), Not(HasSubstr("As published"))));
  EXPECT_THAT(report, testing::ContainsRegex("A tutor led the hand .S01-session-1.h5 trial 1.: "
                                             "alone 0 of .* led [1-9]"));
  const auto json = nlohmann::json::parse(test::read_text(*folder_ / "out" / "statistics.json"));
  const auto& learning = json.at("learning");
  EXPECT_EQ(learning.at("baseline"), "pre-test");
  EXPECT_EQ(learning.at("tests"), (std::vector<std::string>{"post-test", "retention"}));
  ASSERT_EQ(learning.at("outcomes").size(), 3u);
  EXPECT_EQ(learning.at("outcomes")[0].at("changes").at("planned").size(), 3u);

  // The mean of a group in a test, computed anew from the table of procedures.
  const std::vector<Row> rows = table(test::read_text(*folder_ / "out" / "metrics.csv"));
  double sum = 0.0;
  int count = 0;
  for (const Row& row : rows) {
    if (row.at("group") == "alone" && row.at("session_name") == "post-test") {
      EXPECT_EQ(row.at("session_number"), "4");
      sum += std::stod(row.at("cavity_removed_percent"));
      ++count;
    }
  }
  ASSERT_EQ(count, 2);
  for (const auto& mean : learning.at("outcomes")[0].at("means")) {
    if (mean.at("group") == "alone" && mean.at("session") == "post-test") {
      EXPECT_NEAR(mean.at("mean").at("mean").get<double>(), sum / count, 1e-6 * sum);
      --count;
    }
  }
  EXPECT_EQ(count, 1) << "found once";
}

TEST_F(LearningSessionTest, AMistakeInThePlanGetsASentence) {
  const auto refusal = [](const std::string& what, const std::string& by) {
    test::write_text(*folder_ / "bad.toml", test::replaced(short_study(), what, by));
    return refused("validate bad.toml");
  };
  EXPECT_THAT(refusal("shown_in = [\"hints\"]", "shown_in = [\"hint\"]"),
              AllOf(HasSubstr("hints.shown_in"), HasSubstr("alone, hints, led, control")));
  EXPECT_THAT(refusal("groups = [\"alone\", \"hints\", \"led\"]", "groups = [\"lone\"]"),
              HasSubstr("design.session.2.groups"));
  EXPECT_THAT(refusal("name = \"retention\"", "name = \"post-test\""),
              HasSubstr("two sessions called \"post-test\""));
  EXPECT_THAT(refusal("baseline = \"pre-test\"", "baseline = \"before\""),
              HasSubstr("a session: pre-test, training, second training, post-test, retention"));
  EXPECT_THAT(refusal("\"visible_share\"", "\"visible_shar\""),
              HasSubstr("did you mean visible_share?"));
  EXPECT_THAT(refusal("\"led, post-test > alone, post-test\"", "\"led > nobody\""),
              HasSubstr("names 'nobody'"));
  EXPECT_THAT(refusal("sessions = 5 ", "sessions = 6 "), HasSubstr("says nothing of session 6"));
}

/// Virtual surgeons learn from the procedures of the sessions to which they come.
TEST_F(LearningSessionTest, ProceduresOfEarlierDaysAreCountedByGroup) {
  const Experiment experiment = load_experiment(kStudy);
  const auto& d = dynamic_cast<const protocols::BoneDefinition&>(*experiment.definition);
  EXPECT_EQ(d.procedures_before(1, "hints"), 0);
  EXPECT_EQ(d.procedures_before(4, "hints"), 5);
  EXPECT_EQ(d.procedures_before(4, "control"), 1);
  EXPECT_EQ(d.procedures_before(5, "control"), 2);
  EXPECT_EQ(d.sessions_of("control"), 3);
}

/// With one procedure a session, "every other" would else give a person one condition for ever.
TEST_F(LearningSessionTest, EveryOtherProcedureIsEveryOtherOfTheCourse) {
  const Experiment experiment = load_experiment(kStudy);
  const auto& d = dynamic_cast<const protocols::BoneDefinition&>(*experiment.definition);
  EXPECT_EQ(d.in_course(2, {1, 0, "hints"}).trial, 1) << "the pre-test gives nothing";
  EXPECT_EQ(d.in_course(3, {1, 0, "hints"}).trial, 3);
  EXPECT_EQ(d.in_course(3, {0, 0, "hints"}).trial, 0) << "practice";
  EXPECT_EQ(d.in_course(3, {1, 0, "control"}).trial, 1) << "did not come to the training";
}

}  // namespace
}  // namespace haptrial::experiments::learning_session_test
