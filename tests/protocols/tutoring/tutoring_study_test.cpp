// The shipped study of an expert's hand: a small dry run of it, and that its tests keep their
// level.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/study_statistics.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/partner_rows.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/condition_null.h"
#include "tests/support/null_levels.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::tutoring_study_test {
namespace {

using analysis::StudyStatistics;
using test::run_command;
using testing::HasSubstr;

const std::string kDefinition = HAPTRIAL_SOURCE_DIR "/experiments/tutoring_study.toml";

std::vector<analysis::TrialScore> shipped_scores() {
  const std::string file = HAPTRIAL_SOURCE_DIR "/results/tutoring_study/scores.csv";
  return analysis::read_scores_csv(test::read_text(file), file).scores;
}

/// In-plane distances of a test run from where its stimulus is at the same time, computed anew.
double path_error(const record::SessionReader& reader, const record::PassRow& pass) {
  std::vector<record::StimulusRow> ideal = reader.stimuli();
  std::erase_if(ideal, [&](const record::StimulusRow& row) { return row.block != pass.block; });
  double squares = 0.0, time = 0.0;
  std::size_t at = 0;
  int ticks = 0;
  for (const record::Sample& s :
       reader.samples(pass.first_sample, pass.last_sample - pass.first_sample + 1)) {
    if (s.stage != record::Stage::kRun) {
      continue;
    }
    while (at + 2 < ideal.size() && ideal[at + 1].time < time) {
      ++at;
    }
    const double span = ideal[at + 1].time - ideal[at].time;
    const double part = std::min(1.0, (time - ideal[at].time) / span);
    const Eigen::Vector3d away =
        s.position - (1.0 - part) * ideal[at].position - part * ideal[at + 1].position;
    squares += away.x() * away.x() + away.z() * away.z();
    time += 1e-3;
    ++ticks;
  }
  return std::sqrt(squares / ticks);
}

TEST(TutoringStudyTest, ADryRunIsRecordedScoredAndReported) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "study").string();
  const auto made =
      run_command("haptrial dry-run '" + kDefinition + "' --subjects 3 --trials 9 --out '" + out +
                  "' && haptrial analyze '" + out + "'");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output, HasSubstr("mean path error"));
  const auto scores =
      analysis::read_scores_csv(test::read_text(folder / "study/scores.csv"), "scores.csv").scores;
  ASSERT_EQ(scores.size(), 27u);
  const record::SessionReader session(folder / "study/S01.h5");
  const auto passes = session.passes();
  for (const analysis::TrialScore& score : scores) {
    ASSERT_TRUE(score.path_error);
    EXPECT_EQ(score.kept.has_value(), score.condition != "watching");
    if (score.subject != "S01") {
      continue;
    }
    const auto pass = std::ranges::find_if(passes, [&](const record::PassRow& row) {
      return row.trial == score.trial && row.phase == record::Phase::kTest;
    });
    ASSERT_NE(pass, passes.end());
    EXPECT_NEAR(*score.path_error, path_error(session, *pass), 2e-5) << score.trial;
  }
  const std::string report = test::read_text(folder / "study/report.md");
  EXPECT_THAT(report, HasSubstr("## Recall of the path by training condition"));
  EXPECT_THAT(report, HasSubstr("Path error was "));
  EXPECT_THAT(report, HasSubstr("SIMULATED PARTICIPANTS"));
  const auto json = nlohmann::json::parse(test::read_text(folder / "study/statistics.json"));
  EXPECT_EQ(json["path"]["conditions"].size(), 3u);
  const auto refused = run_command("haptrial dry-run '" + kDefinition + "' --subjects 1 --tutor '" +
                                   out + "/S01.h5' --out '" + (folder / "led").string() + "'");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("have an expert of their own"));
}

/// P values that the report prints with participants as the unit.
std::map<std::string, double> printed(const StudyStatistics& s, const std::string& of) {
  std::map<std::string, double> p;
  p[of + " repeated measures"] = s.repeated->p_corrected;
  p[of + " Friedman"] = s.friedman->p;
  for (const auto& test : s.tests.planned.tests) {
    p[of + " t, " + text_of(test.sides)] = test.t->p;
    p[of + " ranks, " + text_of(test.sides)] = test.ranks->p;
  }
  return p;
}

TEST(TutoringStudyTest, TestsKeepTheirLevelWhereConditionsDoNotDiffer) {
  constexpr std::size_t kStudies = 200;
  const auto scores = shipped_scores();
  analysis::StudyQuestions questions;
  questions.plan =
      analysis::parse_analysis_plan({"both < watching", "both < playback"}, "", "the test");
  RandomStream random(1, "tutoring null");
  std::map<std::string, std::size_t> below;
  std::size_t pooled = 0;  // trials as if they were independent: the band tells that they are not
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto null = test::with_permuted_names(scores, random);
    for (auto& score : null) {
      score.levels = {score.condition};
    }
    const StudyStatistics force = study_statistics(null, questions);
    pooled += force.anova->p < 0.05 ? 1 : 0;
    auto all = printed(force, "force:");
    all.merge(printed(*path_statistics(null, questions), "path:"));
    for (const auto& [name, p] : all) {
      below[name] += p < 0.05 ? 1 : 0;
    }
  }
  EXPECT_EQ(below.size(), 12u);
  const auto band = test::binomial_band(kStudies, 0.999);
  for (const auto& [name, count] : below) {
    RecordProperty(name, static_cast<int>(count));
    EXPECT_LE(count, band.high) << name;
  }
  RecordProperty("pooled", static_cast<int>(pooled));
  EXPECT_GT(pooled, band.high);
}

/// Assumptions about the virtual learners show: two senses are better than one, and a led hand
/// stays behind as far as its drag over the spring says.
TEST(TutoringStudyTest, TheShippedResultsAreThoseOfTheAssumptions) {
  std::map<std::string, std::array<double, 3>> sums;
  for (const auto& score : shipped_scores()) {
    auto& [count, path, kept] = sums[score.condition];
    count += 1.0;
    path += *score.path_error;
    kept += score.kept.value_or(0.0);
  }
  const auto path = [&](const char* of) { return sums.at(of)[1] / sums.at(of)[0]; };
  EXPECT_LT(path("both"), path("playback"));
  const double lag = 0.02 * (15.0 + 250.0 * 0.1) / 200.0;  // [m]
  for (const char* led : {"playback", "both"}) {
    EXPECT_NEAR(sums.at(led)[2] / sums.at(led)[0], lag, 0.35 * lag) << led;
  }
}

}  // namespace
}  // namespace haptrial::tutoring_study_test
