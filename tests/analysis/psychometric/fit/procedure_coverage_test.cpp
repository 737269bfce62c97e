// The claims of docs/algorithms/procedure-coverage.md, for those cases that are to hold 93 to 97 %.

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <algorithm>

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

TEST(ProcedureCoverage, FourTracksHoldTheThreshold) {
  const StudyResult r = result_of("2-down/1-up, four tracks", 1000);
  expect_held(r.natural, "mean of the tracks");
  expect_held(r.threshold, "fit of their trials");
}

TEST(ProcedureCoverage, PosteriorOfPsiHoldsTheThreshold) {
  expect_held(result_of("Psi", 500).natural, "posterior");
}

}  // namespace
}  // namespace haptrial::test
