// The claims of docs/algorithms/procedure-coverage.md, for those cases that are to hold 93 to 97 %.

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/analysis/psychometric/fit/coverage_grid.h"
#include "tests/analysis/psychometric/fit/procedure_study.h"

namespace haptrial::test {
namespace {

StudyResult result_of(const std::string& name, int observers) {
  const auto studies = procedure_studies();
  const auto found = std::find_if(studies.begin(), studies.end(),
                                  [&](const ProcedureStudy& s) { return s.name == name; });
  return found == studies.end() ? StudyResult{} : run_study(*found, observers, 1);
}

/// A count that is not so small or large that an interval which holds the truth in 93 to 97 % would
/// give it once in a thousand studies.
void expect_held(const Tally& tally, const std::string& what) {
  ASSERT_GT(tally.observers, 0) << what;
  const auto n = static_cast<unsigned>(tally.observers);
  const auto held = static_cast<unsigned>(tally.held);
  EXPECT_GT(gsl_cdf_binomial_P(held, 0.93, n), 1e-3) << what << ": " << held << " of " << n;
  EXPECT_GT(gsl_cdf_binomial_Q(held, 0.97, n), 1e-3) << what << ": " << held << " of " << n;
}

TEST(ProcedureCoverage, ConstantStimuliHoldThresholdAndWidth) {
  for (const char* name : {"constant stimuli, forced choice", "constant stimuli, yes/no"}) {
    const StudyResult r = result_of(name, 1000);
    expect_held(r.threshold, std::string(name) + ", threshold");
    expect_held(r.width, std::string(name) + ", width");
  }
}

class SingleTrackCoverage : public testing::TestWithParam<const char*> {};

TEST_P(SingleTrackCoverage, HoldsTheThreshold) {
  const StudyResult r = result_of(GetParam(), 150);
  expect_held(r.natural, "own estimate");
  expect_held(r.threshold, "fit");
  EXPECT_LT(r.profile.coverage(), 0.93) << "the posterior would not be needed";
}

INSTANTIATE_TEST_SUITE_P(Procedures, SingleTrackCoverage,
                         testing::Values("2-down/1-up", "3-down/1-up", "weighted up-down", "PEST"));

TEST(ProcedureCoverage, FourTracksHoldTheThreshold) {
  const StudyResult r = result_of("2-down/1-up, four tracks", 300);
  expect_held(r.natural, "mean of the tracks");
  expect_held(r.threshold, "fit of their trials");
  expect_held(r.width, "width");
}

class BayesianProcedureCoverage : public testing::TestWithParam<const char*> {};

TEST_P(BayesianProcedureCoverage, HoldsTheThreshold) {
  const StudyResult r = result_of(GetParam(), 150);
  expect_held(r.natural, "posterior");
  expect_held(r.threshold, "fit");
  expect_held(r.width, "width of the fit");
}

INSTANTIATE_TEST_SUITE_P(Procedures, BayesianProcedureCoverage,
                         testing::Values("Psi", "Psi that assumes no lapses",
                                         "QUEST+ with lapses"));

/// Lapses and false alarms beyond what was usual, and thresholds at and beyond the last level: the
/// interval holds the truth, or there is none.
TEST(ProcedureCoverage, TroublesLeaveIntervalsThatHoldTheThreshold) {
  const std::vector<CoverageCell> cells{{"listed", 1, 0, 0.02, 0.3},
                                        {"listed", 4, 0, 0.15},
                                        {"listed", 2, 1},
                                        {"staircase", 2, 2},
                                        {"staircase", 1, 0, 0.1, 0.3},
                                        {"PEST", 4, 1},
                                        {"Psi", 2, 0, 0.15},
                                        {"QUEST+", 1, 2}};
  for (const CoverageCell& cell : cells) {
    const CellCounts counts = count_coverage(cell, 80, 2);
    const auto n = static_cast<unsigned>(counts.fit.stated);
    ASSERT_GT(n, 0U) << cell.procedure;
    // Fewer than 93 % may be held once in 1,000 studies.
    EXPECT_GT(gsl_cdf_binomial_P(static_cast<unsigned>(counts.fit.held), 0.93, n), 1e-3)
        << cell.procedure << " " << cell.alternatives << ": " << counts.fit.held << " of " << n;
  }
}

TEST(ProcedureCoverage, SettingsAndMagnitudesHoldWhatTheyAreMeantFor) {
  expect_held(result_of("adjustment", 1000).natural, "adjustment");
  expect_held(result_of("magnitude estimation", 1000).natural, "exponent");
}

}  // namespace
}  // namespace haptrial::test
