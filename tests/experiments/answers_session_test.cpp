// Answers by place and answers out of time in a session's file: what its samples, its analysis and
// its replay make of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "analysis/psychophysics/data/read_trials.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/felt_or_not.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using record::ResponseSource;

class AnswersSessionTest : public testing::Test {
 protected:
  std::unique_ptr<record::SessionReader> run(const std::string& text) {
    test::write_text(folder_ / "study.toml", text);
    experiment_ = load_experiment(folder_ / "study.toml");
    SessionRequest request = test::session_request(experiment_, file(), 7);
    const SessionSummary summary = run_session(request);
    EXPECT_EQ(summary.aborted_passes, 0);
    auto reader = std::make_unique<record::SessionReader>(file());
    EXPECT_TRUE(record::check_session(*reader, known_tables()).ok);
    return reader;
  }
  std::filesystem::path file() const { return folder_ / "S01.h5"; }
  test::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(AnswersSessionTest, TheSamplesShowWhenTheTipCameIntoItsPlace) {
  const auto file = run(test::felt_or_not(
      "choices = [{ value = \"yes\", touch = \"right\" }, { value = \"no\", touch "
      "= \"left\" }]\n"));
  const auto responses = file->responses();
  ASSERT_EQ(responses.size(), 12u);
  std::map<std::string, int> given;
  for (const record::ResponseRow& row : responses) {
    ++given[row.text];
    EXPECT_EQ(row.source, ResponseSource::kPlace);
    EXPECT_EQ(row.code, row.text == "yes" ? 1 : 0) << "left is the first region by name";
    // The tick on which the tip came in, by the samples themselves, whose grid is a micrometre.
    const auto beyond = [&](std::uint64_t tick) {  // the edge of the place [m]
      const Eigen::Vector3d p = file->samples(tick, 1).front().position;
      const Eigen::Vector3d from(p.x() - (row.text == "yes" ? 0.03 : -0.03), p.y(), p.z());
      return (row.text == "yes" ? from.cwiseAbs().maxCoeff() : from.norm()) - 0.01;
    };
    EXPECT_LT(beyond(row.sequence), 1e-6);
    EXPECT_GT(beyond(row.sequence - 1), -1e-6);
    EXPECT_LT(beyond(row.sequence + 200), 0.0);
  }
  EXPECT_EQ(given["yes"], 6);
  EXPECT_EQ(given["no"], 6);
  // The reaction counts from the end of the last stage, in ticks.
  std::map<std::int32_t, std::uint64_t> asked;
  for (const record::StageRow& stage : file->rows<record::StageRow>()) {
    asked[stage.pass] = stage.last_sample + 1;
  }
  for (const record::ResponseRow& row : responses) {
    const auto ticks = static_cast<double>(row.sequence - asked.at(row.pass) + 1);
    EXPECT_NEAR(row.reaction_time, ticks / 1000.0, 1e-9);
  }
}

const char* const kTwoKeys =
    "choices = [{ value = \"yes\" }, { value = \"no\" }]\ntoo_fast = 0.5\ntoo_slow = 0.7\n";

TEST_F(AnswersSessionTest, AnalysisAndReplayKnowWhichTrialsCameAgain) {
  const auto file = run(test::felt_or_not(std::string(kTwoKeys) + "out_of_time = \"repeat\"\n"));
  std::map<std::int32_t, bool> again;
  for (const record::OutOfTimeRow& row : file->rows<record::OutOfTimeRow>()) {
    EXPECT_TRUE(row.again);
    again[row.pass] = true;
  }
  ASSERT_GT(again.size(), 0u);
  std::map<double, int> learnt;
  for (const record::LevelRow& row : file->rows<record::LevelRow>()) {
    EXPECT_EQ(std::isnan(row.outcome), again.contains(row.pass));
    learnt[row.applied] += std::isnan(row.outcome) ? 0 : 1;
  }
  EXPECT_EQ(learnt, (std::map<double, int>{{0.02, 6}, {1.0, 6}}));
  EXPECT_EQ(file->passes().size(), 12u + again.size());
  int counted = 0;
  for (const auto& trial : analysis::trials::read_trials({this->file()}, nullptr, 1).trials) {
    counted += trial.counts() ? 1 : 0;
  }
  EXPECT_EQ(counted, 12) << "the analysis takes each level as often as it was planned";
  // A replay goes the way from recorded answers to the last trial; other values would be refused.
  protocols::ReplayRequest request;
  request.file = this->file();
  request.trial = static_cast<int>(file->passes().size());
  request.fps = 5;
  request.pictures = true;
  request.picture = [](const render::Image&) {};
  request.progress = [](double, double, const std::string&, double) {};
  request.tell = [](const std::string&) {};
  EXPECT_NO_THROW(experiment_.study->protocol().replay(request));
}

}  // namespace
}  // namespace haptrial::experiments
