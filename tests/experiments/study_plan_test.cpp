// A study under a plan: what is written, what sessions and reports say, and which deviations are
// named (plan_studies.py).

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::study_plan_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class StudyPlanTest : public testing::Test {
 protected:
  test::CommandResult run(const std::string& arguments) const {
    return test::run_command("cd '" + folder_.path().string() + "' && haptrial " + arguments);
  }
  /// The shipped study of forces, with a plan.
  void write_study(const std::string& plan) const {
    test::write_text(folder_ / "study.toml", test::shipped_text() + "\n[plan]\n" + plan);
  }
  /// What the report of a study of any protocol says of its plan.
  nlohmann::json stated_and_done(const std::string& results) const {
    const auto json = nlohmann::json::parse(file_text(folder_ / "out" / results));
    const std::string report = file_text(folder_ / "out/report.md");
    EXPECT_EQ(report.find("\n## "), report.find("\n## Stated and done"));
    return json["own_findings"]["stated_and_done"];
  }

  test::TemporaryFolder folder_;
};

TEST_F(StudyPlanTest, IsWrittenOnceAndNamesWhatChanged) {
  write_study("hypotheses = [\"Forces are recalled better after visuohaptic training\"]\n");
  const auto written = run("plan study.toml");
  ASSERT_EQ(written.status, 0) << written.errors;
  EXPECT_THAT(written.output, HasSubstr("plan: study.plan.json\ndocument: study.plan.html\n"));
  const std::string plan = file_text(folder_ / "study.plan.json");
  const std::string document = file_text(folder_ / "study.plan.md");
  EXPECT_THAT(document, AllOf(HasSubstr("Forces are recalled better after visuohaptic training"),
                              HasSubstr("visuohaptic < visual"), HasSubstr("12 participants"),
                              HasSubstr("nobody is excluded"), HasSubstr("force_weight = 1.0")));
  EXPECT_THAT(file_text(folder_ / "study.plan.html"), HasSubstr("<h2"));

  const auto again = run("plan study.toml");
  EXPECT_EQ(again.status, 0) << again.errors;
  EXPECT_THAT(again.output, HasSubstr("the same plan is there already: study.plan.json"));
  write_study("hypotheses = [\"Forces are recalled worse\"]\n");
  const auto refused = run("plan study.toml");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors,
              AllOf(HasSubstr("study.plan.json: is another plan, made at "),
                    HasSubstr("plan.hypotheses was "), HasSubstr("recalled worse")));
  EXPECT_EQ(file_text(folder_ / "study.plan.json"), plan);
  EXPECT_EQ(file_text(folder_ / "study.plan.md"), document);
}

TEST_F(StudyPlanTest, PowerIsThatOfTheTestOrOfASimulation) {
  write_study("effect = 0.9\nretain_until = \"2120-02-29\"\n");
  const auto planned = run("plan study.toml");
  ASSERT_EQ(planned.status, 0) << planned.errors;
  const auto closed = run("power t --design paired --delta 0.9 --sd 1 --n 12");
  ASSERT_EQ(closed.status, 0) << closed.errors;
  const double power = std::stod(closed.output.substr(closed.output.find("power ") + 6));
  EXPECT_THAT(file_text(folder_ / "study.plan.md"),
              HasSubstr(fmt::format("a power of {:.3f}", power)));

  const std::string recall = HAPTRIAL_SOURCE_DIR "/results/power_recall";
  const auto simulated = run("plan study.toml --out simulated --power " + recall);
  ASSERT_EQ(simulated.status, 0) << simulated.errors;
  EXPECT_THAT(
      file_text(folder_ / "simulated/study.plan.md"),
      AllOf(HasSubstr("found with 12 participants in 70.5 %"), HasSubstr("paired t, at 0.05")));
  const auto other =
      run("plan study.toml --out other --power " HAPTRIAL_SOURCE_DIR "/results/power_repetition");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("is of the study stiffness_discrimination"));
  EXPECT_EQ(run("plan study.toml --out other --power .").status, 2);
}

/// A new plan has a day that is to come; one that was made long ago says when its day is over.
TEST_F(StudyPlanTest, DataIsKeptUntilADayThatIsToCome) {
  write_study("retain_until = \"2020-02-29\"\n");
  const auto refused = run("plan study.toml");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("study.toml: plan.retain_until is 2020-02-29, which is "
                                        "over; allowed: a date from today on"));
  EXPECT_FALSE(fs::exists(folder_ / "study.plan.json"));
  write_study("retain_until = \"2120-02-29\"\n");
  ASSERT_EQ(run("plan study.toml").status, 0);
  std::string aged = file_text(folder_ / "study.plan.json");
  for (auto at = aged.find("2120-02-29"); at != std::string::npos; at = aged.find("2120-02-29")) {
    aged.replace(at, 10, "2020-02-29");
  }
  test::write_text(folder_ / "study.plan.json", aged);
  write_study("retain_until = \"2020-02-29\"\n");
  const auto over = run("plan study.toml");
  EXPECT_THAT(over.output + over.errors, HasSubstr("2020-02-29, which is over"));
  EXPECT_EQ(over.status, 0) << over.errors;
}

TEST_F(StudyPlanTest, MistakesOfATableAreNamed) {
  const auto refused = [&](const std::string& plan) {
    write_study(plan);
    const auto done = run("validate study.toml");
    EXPECT_EQ(done.status, 2);
    return done.errors;
  };
  EXPECT_THAT(refused("retain_until = \"soon\"\n"), HasSubstr("a date such as 2036-12-31"));
  EXPECT_THAT(refused("looks = [6, 4]\n"), HasSubstr("whole numbers of participants, rising"));
  EXPECT_THAT(refused("looks = [2.5]\n"), HasSubstr("whole numbers of participants, rising"));
  EXPECT_THAT(refused("looks = [4, 4]\n"), HasSubstr("whole numbers of participants, rising"));
  EXPECT_THAT(refused("retain_until = \"2027-02-29\"\n"), HasSubstr("a date such as"));
  EXPECT_THAT(refused("effect = 0.0\n"), HasSubstr("other than 0"));
  EXPECT_THAT(refused("hypothesis = []\n"), HasSubstr("plan.hypothesis is not a known key"));
  write_study("looks = [6, 30]\n");
  const auto done = run("plan study.toml");
  EXPECT_EQ(done.status, 2);
  EXPECT_THAT(done.errors,
              HasSubstr("plan.looks has 30; allowed: up to the 12 participants of the study"));
}

TEST_F(StudyPlanTest, ReportsOfForcesOpenWithIt) {
  write_study("looks = [2]\n");
  ASSERT_EQ(run("plan study.toml").status, 0);
  const auto dry = run("dry-run study.toml --subjects 2 --trials 12 --out out");
  ASSERT_EQ(dry.status, 0) << dry.errors;
  const auto info = run("info out/S01.h5");
  EXPECT_THAT(info.output, HasSubstr("plan "));
  const auto done = run("analyze out --planned 'haptic < visual'");
  ASSERT_EQ(done.status, 0) << done.errors;
  const auto found = stated_and_done("statistics.json");
  std::vector<std::string> kinds;
  for (const auto& each : found["tables"]["deviations"]) {
    kinds.push_back(each["kind"]);
  }
  EXPECT_THAT(kinds, testing::ElementsAre("people_missing", "trials_dropped", "trials_dropped",
                                          "tests_changed"));
  EXPECT_THAT(
      done.output,
      HasSubstr("kind: people_missing; deviation: 2 participants took part, 12 were stated"));
}

TEST_F(StudyPlanTest, ReportsOfDrillingsOpenWithIt) {
  test::write_small_drilling(folder_.path(), 3.0);
  ASSERT_EQ(run("plan study.toml").status, 0);
  const auto dry = run("dry-run study.toml --out out");
  ASSERT_EQ(dry.status, 0) << dry.errors;
  const auto done = run("analyze out");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(stated_and_done("statistics.json")["findings"]["deviations"]["estimate"], 0);
}

/// Lights beside the other finger slow everybody down, so a few participants decide.
TEST_F(StudyPlanTest, AStatedRuleMayEndTheStudyAndLookAtAnyTime) {
  for (const char* file : {"crossmodal_congruency.toml", "congruency.py"}) {
    fs::copy_file(fs::path(HAPTRIAL_SOURCE_DIR "/docs/worked/everyday") / file, folder_ / file);
  }
  fs::rename(folder_ / "crossmodal_congruency.toml", folder_ / "study.toml");
  ASSERT_EQ(run("set study.toml analysis.sequential.rule '\"bayes factor\"'").status, 0);
  ASSERT_EQ(run("set study.toml analysis.sequential.fewest 2").status, 0);
  ASSERT_EQ(run("plan study.toml").status, 0);
  ASSERT_EQ(run("dry-run study.toml --subjects 2 --parts out").status, 0);
  ASSERT_EQ(run("analyze out").status, 0);
  ASSERT_EQ(run("dry-run study.toml --subjects 6 --parts out").status, 0);
  const auto next = run("next study.toml out");
  ASSERT_THAT(next.output, HasSubstr("the study has ended: there is an effect"));
  const int decided = std::stoi(next.output.substr(next.output.find("after ") + 6));
  ASSERT_EQ(run("analyze out").status, 0);
  const auto all = stated_and_done("results.json")["tables"];
  ASSERT_EQ(all["deviations"].size(), 1U) << all;
  EXPECT_EQ(all["deviations"][0]["kind"], "people_extra");
  EXPECT_THAT(std::string(all["deviations"][0]["what"]),
              HasSubstr("ended by its rule after " + std::to_string(decided)));
  for (int number = decided + 1; number <= 6; ++number) {
    const std::string who = "S0" + std::to_string(number);
    ASSERT_EQ(run("withdraw out " + who + " --yes").status, 0);
  }
  ASSERT_EQ(run("analyze out").status, 0);
  EXPECT_EQ(stated_and_done("results.json")["findings"]["deviations"]["estimate"], 0);
}

/// Somebody is excluded and somebody comes when the result is known.
TEST_F(StudyPlanTest, LooksAreJudgedByTheOrderOfTheLog) {
  test::write_text(folder_ / "study.toml", R"([experiment]
protocol = "trials"
name = "weights"
[design]
participants = 2
[factors]
push = [0.5, 1.5]
[fields.weight]
type = "constant"
force = [0.0, 0.0, "-$push"]
[[stages]]
name = "before"
until = { time = 0.01 }
[[stages]]
name = "feel"
fields = ["weight"]
until = { time = 0.03 }
[response]
name = "heavy"
question = "Is it heavy?"
choices = [{ value = "yes" }, { value = "no" }]
[[blocks]]
name = "main"
trials = 6
[observer]
decides = "yes"
criterion = 0.8
reaction = 0.1
[observer.actions]
feel = { do = "hold" }
[analysis]
kind = "times"
tests = ["1.5 < 0.5"]
by = ["push"]
[plan]
hypotheses = ["Heavy weights are answered sooner than light ones"]
exclusions = ["left early"]
)");
  const auto analyzed = [this](const std::string& options, int status) {
    const auto done = run("analyze out " + options);
    EXPECT_EQ(done.status, status) << done.errors;
    std::vector<std::string> kinds;
    if (status == 0) {
      nlohmann::json found = stated_and_done("results.json");
      for (const auto& each : found["tables"]["deviations"]) {
        kinds.push_back(each["kind"]);
      }
    }
    return kinds;
  };
  ASSERT_EQ(run("plan study.toml").status, 0);
  ASSERT_EQ(run("dry-run study.toml --out out").status, 0);
  analyzed("--planned '1.5 < 0,5'", 2);  // nothing of it was seen
  EXPECT_THAT(analyzed("", 0), testing::IsEmpty());
  ASSERT_EQ(run("roster study.toml out --exclude S02 --because 'left early'").status, 0);
  EXPECT_THAT(analyzed("", 0), testing::ElementsAre("people_missing", "excluded_late"));
  ASSERT_EQ(run("run study.toml --subject Sb02 --device virtual --out out").status, 0);
  EXPECT_THAT(analyzed("", 0), testing::IsSupersetOf({"looked_at_data", "excluded_late"}));
}

TEST_F(StudyPlanTest, SessionsOfAnotherPlanAreRefused) {
  write_study("");
  ASSERT_EQ(run("plan study.toml").status, 0);
  ASSERT_EQ(run("dry-run study.toml --subjects 1 --trials 1 --parts out").status, 0);
  fs::remove(folder_ / "study.plan.json");
  write_study("exclusions = [\"left early\"]\n");
  ASSERT_EQ(run("plan study.toml").status, 0);
  const auto refused = run("run study.toml --subject P01 --trials 1 --out out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("is another plan than study.plan.json"));
}

/// @param counts  of clean and of planted studies
void expect_all_right(const fs::path& folder, const std::string& counts) {
  const auto judged = test::run_command("/usr/bin/python3 -B '" HAPTRIAL_SOURCE_DIR
                                        "/tests/experiments/plan_studies.py' "
                                        "\"$HAPTRIAL\" '" +
                                        folder.string() + "' " + counts);
  EXPECT_EQ(judged.status, 0) << judged.output << judged.errors;
  EXPECT_THAT(judged.output, HasSubstr("\n0 wrong\n"));
}

TEST_F(StudyPlanTest, CleanStudiesHaveNoDeviation) { expect_all_right(folder_ / "all", "7 0"); }

TEST_F(StudyPlanTest, EveryPlantedDeviationIsNamed) { expect_all_right(folder_ / "all", "0 28"); }

}  // namespace
}  // namespace haptrial::experiments::study_plan_test
