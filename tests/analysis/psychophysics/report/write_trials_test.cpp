// The whole way: sessions in a folder, read, analysed, written.
#include "analysis/psychophysics/report/write_trials.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "analysis/files/csv.h"
#include "analysis/psychometric/fit/stated_fit.h"
#include "analysis/psychophysics/data/read_trials.h"
#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/file_text.h"
#include "tests/analysis/psychophysics/simulated_trials.h"
#include "tests/analysis/psychophysics/study/simulated_cues.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::trials {
namespace {

using test::SimulatedTask;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class WriteTrials : public testing::TestWithParam<SimulatedTask> {
 protected:
  /// HAPTRIAL_KEEP_REPORTS names a folder in which they stay to be looked at.
  std::filesystem::path place() const {
    const char* keep = std::getenv("HAPTRIAL_KEEP_REPORTS");
    return keep != nullptr
               ? std::filesystem::path(keep) / std::to_string(static_cast<int>(GetParam()))
               : folder_.path() / "report";
  }
  TrialsResult written() {
    test::SimulatedTrials study;
    study.task = GetParam();
    study.participants = 6;
    study.effect = 0.3;
    const std::filesystem::path sessions = folder_.path() / "sessions";
    std::filesystem::create_directories(sessions);
    test::write_sessions(test::simulated_trials(study), sessions, 3);
    std::vector<std::filesystem::path> files;
    for (int p = 1; p <= study.participants; ++p) {
      files.push_back(sessions / ("P0" + std::to_string(p) + ".h5"));
    }
    TrialsPlan plan = test::plan_of(study);
    plan.resamples = 99;
    plan.permutations = 999;
    plan.bayesian = GetParam() == SimulatedTask::kConstant;  // it takes long
    plan.metacognition = GetParam() == SimulatedTask::kDetection;
    plan.diffusion = GetParam() == SimulatedTask::kTimes;
    plan.plan = parse_analysis_plan({"off < on"}, "", "tests");
    TrialsResult result = analyze(read_trials(files, {}, 2), plan, {}, 2);
    result.title = "A study made by hand";
    result.definition = "# made by hand\n";
    result.definition_name = "study.toml";
    write_trials(result, place());
    return result;
  }
  test::TemporaryFolder folder_;
};

TEST_P(WriteTrials, EverythingIsWrittenAndMarkedAsSimulatedTwiceWithEqualBytes) {
  const TrialsResult result = written();
  const std::string markdown = file_text(place() / "report.md");
  EXPECT_THAT(markdown, HasSubstr(kSimulatedTrials));
  for (const std::string& line : summary_lines(result)) {
    EXPECT_THAT(markdown, HasSubstr(line.substr(0, 12))) << line;
    EXPECT_THAT(line, Not(HasSubstr("nan")));
  }
  EXPECT_THAT(markdown, Not(HasSubstr("nan")));
  EXPECT_THAT(markdown, HasSubstr("(simulated)"));
  EXPECT_THAT(file_text(place() / "report.html"), HasSubstr("SIMULATED PARTICIPANTS"));
  EXPECT_THAT(file_text(place() / "report.html"), HasSubstr("# made by hand"));
  const auto json = nlohmann::json::parse(file_text(place() / "results.json"));
  EXPECT_TRUE(json.at("simulated").get<bool>());
  EXPECT_EQ(json.at("participants").size(), 6u);
  EXPECT_FALSE(json.at("quantities").empty());
  const CsvTable trials = CsvTable::load(place() / "trials.csv");
  EXPECT_EQ(trials.rows(), result.data.trials.size());
  const CsvTable estimates = CsvTable::load(place() / "estimates.csv");
  EXPECT_GT(estimates.rows(), 0u);
  for (const double value : estimates.numbers(estimates.column("estimate"))) {
    EXPECT_TRUE(std::isfinite(value));
  }

  const std::string first = file_text(place() / "results.json") + file_text(place() / "report.md");
  std::filesystem::remove_all(folder_.path() / "sessions");
  std::filesystem::remove_all(place());
  written();
  EXPECT_EQ(first, file_text(place() / "results.json") + file_text(place() / "report.md"));
}

/// A panel for each participant, with every step of the track in its own place.
TEST_P(WriteTrials, TracksOfAllParticipantsStandBesideEachOther) {
  const TrialsResult result = written();
  const std::vector<Figure> panels = panel_figures(result);
  EXPECT_EQ(panels.empty(), std::ranges::none_of(result.tracks, &TrackEstimate::adaptive));
  for (const Figure& panel : panels) {
    ASSERT_EQ(panel.x_names.size(), 6u);
    std::map<std::string, std::multiset<double>> drawn, presented;
    for (const Series& series : panel.series) {
      if (series.mark != Mark::kPoints) {
        continue;
      }
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        const auto place = static_cast<std::size_t>(std::lround(series.x[i])) - 1;
        EXPECT_NEAR(panel.x_names[place].first, series.x[i], 0.45) << "no panel meets another";
        drawn[panel.x_names[place].second].insert(series.y[i]);
      }
    }
    for (const TrackEstimate& track : result.tracks) {
      if (panel.title.ends_with(": " + track.track)) {
        for (const TrackStep& step : track.steps) {
          presented[track.participant].insert(step.applied);
        }
      }
    }
    EXPECT_EQ(drawn, presented);
    EXPECT_THAT(file_text(place() / "report.md"), HasSubstr(panel.name + ".svg"));
  }
}

TEST(TrialsTextTest, MethodsStateTheRuleByWhichIntervalsAreWidened) {
  TrialsResult result;
  result.plan.functions = true;
  result.fits.resize(1);  // of listed levels
  result.series.resize(1);
  EXPECT_THAT(to_markdown(trials_report(result, {})),
              HasSubstr(fmt::format("(p below {} of the deviance)", kUnusualScatter)));
  EXPECT_EQ(kUnusualScatter, 0.2);
  result.plan.resamples = 0;
  EXPECT_THAT(
      to_markdown(trials_report(result, {})),
      AllOf(HasSubstr("without bootstrap samples"),
            HasSubstr(fmt::format("(p below {} of the deviance by chi-square)", kUnusualScatter)),
            Not(HasSubstr("bias-corrected"))));
  const FindingRow row = function_findings(result).rows.at(0);
  const auto from = std::ranges::find(row, "estimates_from", &Finding::name);
  ASSERT_NE(from, row.end());
  EXPECT_EQ(*from->value.word(), "profile likelihood");
}

/// Reaction times, and errors that nobody made, before and after.
TEST(TrialsTextTest, MethodsSayOnceHowConditionsAndThatChangesWereCompared) {
  TrialsResult result;
  result.plan.kind = AnalysisKind::kTimes;
  result.plan.by = {"side", "session"};
  result.plan.baseline = "before";
  result.plan.permutations = 99;
  std::vector<QuantityValue> times, errors;
  for (int person = 0; person < 6; ++person) {
    const std::string name = fmt::format("P{}", person);
    for (const char* side : {"left", "right"}) {
      for (const char* session : {"before", "after"}) {
        const bool slower = side == std::string("right") && session == std::string("after");
        times.push_back({name, {side, session}, 0.5 + (slower ? 0.1 + 0.01 * person : 0.0)});
        errors.push_back({name, {side, session}, 0.0});
      }
    }
  }
  result.quantities = {quantity("time", "time", "s", times, result.plan),
                       quantity("errors", "errors", "", errors, result.plan)};
  const std::string report = to_markdown(trials_report(result, {}));
  EXPECT_THAT(report, HasSubstr("less the same participant's in the session before."));
  const std::string compared = "Conditions were compared by ";
  const std::size_t first = report.find(compared);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(report.find(compared, first + 1), std::string::npos);
  EXPECT_THAT(report, Not(HasSubstr("the tests of the tables")));
}

TEST(TrialsTextTest, TicksOnWhichABodyWasNotFeltAsItShouldBeAreTold) {
  TrialsResult result;
  StudyTrial trial;
  trial.touched = {{"liver", 400, 0, 0}};
  result.data.trials = {trial, trial, trial};
  EXPECT_THAT(body_lines(result), testing::IsEmpty());
  result.data.trials[0].touched[0].inverted = 7;
  result.data.trials[2].touched[0].inverted = 4;
  result.data.trials[1].touched[0].crowded = 20;
  const auto lines = body_lines(result);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], HasSubstr("In 2 trials, on 11 of 1200 ticks in contact with a body that "
                                  "gives way (0.917 %), the hand pressed it deeper"));
  EXPECT_THAT(lines[1], HasSubstr("In 1 trial, on 20 of 1200 ticks"));
  for (const std::string& line : summary_lines(result)) {
    EXPECT_THAT(line, testing::Not(HasSubstr("ticks"))) << "the results lead, and not the loop";
  }
}

TEST(WriteCues, TheirCombinationLeadsTheReport) {
  test::SimulatedCues study;
  study.participants = 4;
  study.eye_sd = {0.004, 0.006};
  study.exact = true;
  study.repetitions = 40;
  TrialsData data = test::simulated_cues(study);
  std::erase_if(data.trials, [&](const StudyTrial& trial) {
    return trial.session == 3 && factor_level(data, trial, "modality") == "hand";
  });
  TrialsPlan plan = test::plan_of(study);
  plan.resamples = 49;
  TrialsResult result = analyze(std::move(data), plan, {}, 2);
  result.title = "Two cues";
  const auto lines = summary_lines(result);
  ASSERT_GT(lines.size(), 2u);
  EXPECT_THAT(lines[1], HasSubstr("Weight of eye at noise 0: observed"));
  EXPECT_THAT(lines[2], HasSubstr("Standard deviation at noise 0 (m): eye"));
  for (const std::string& line : lines) {
    EXPECT_THAT(line, Not(HasSubstr("more than two factors")));
  }
  const test::TemporaryFolder folder;
  write_trials(result, folder / "report");
  const std::string markdown = file_text(folder / "report/report.md");
  EXPECT_THAT(markdown, HasSubstr("## Combination of cues (simulated)"));
  EXPECT_LT(markdown.find("## Combination of cues"), markdown.find("## Psychometric functions"));
  EXPECT_THAT(markdown, HasSubstr("Left out at noise 0: P04: there are no answers of hand"));
  EXPECT_THAT(markdown, Not(HasSubstr("nan")));
  for (const char* picture : {"report/cues-weights.svg", "report/cues-deviations.svg"}) {
    EXPECT_THAT(file_text(folder / picture), HasSubstr("SIMULATED")) << picture;
  }
  const auto json = nlohmann::json::parse(file_text(folder / "report/results.json"));
  const auto& levels = json.at("cue_combination").at("levels");
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].at("participants").size(), 3u);
  EXPECT_EQ(levels[1].at("left_out").size(), 1u);
  EXPECT_TRUE(levels[0].at("weight_observed_less_predicted").at("test").contains("p"));
  const CsvTable estimates = CsvTable::load(folder / "report/estimates.csv");
  const std::size_t source = estimates.column("source"), noise = estimates.column("noise");
  int rows = 0, second = 0;
  for (std::size_t row = 0; row < estimates.rows(); ++row) {
    const bool cues = estimates.text(row, source) == "cues";
    rows += cues;
    second += cues && estimates.text(row, noise) == "1";
  }
  EXPECT_EQ(rows, 3 * 2 * 6) << "participants, levels, numbers";
  EXPECT_EQ(second, 3 * 6);
}

INSTANTIATE_TEST_SUITE_P(Tasks, WriteTrials,
                         testing::Values(SimulatedTask::kStaircase, SimulatedTask::kConstant,
                                         SimulatedTask::kComparison, SimulatedTask::kDetection,
                                         SimulatedTask::kMagnitude));

}  // namespace
}  // namespace haptrial::analysis::trials
