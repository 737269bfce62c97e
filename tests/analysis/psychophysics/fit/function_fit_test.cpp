// Intervals of a function hold no number that it cannot have.
#include "analysis/psychophysics/fit/function_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace haptrial::analysis::trials {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Right answers of about 33 at each of six levels.
FunctionFit fit_of(const std::array<int, 6>& right) {
  constexpr std::array<double, 6> kLevels{51.0, 53.0, 55.0, 57.0, 60.0, 63.0};
  constexpr std::array<int, 6> kTotals{34, 34, 33, 33, 33, 33};
  AnsweredSeries series;
  series.participant = "P1";
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    for (int trial = 0; trial < kTotals[i]; ++trial) {
      series.trials.push_back(
          {series.trials.size(), kLevels[i], kLevels[i], trial < right[i] ? 1 : 0, 0, 0, ""});
    }
  }
  TrialsPlan plan;
  plan.kind = AnalysisKind::kPsychometric;
  plan.functions = true;
  plan.bayesian = false;
  plan.resamples = 199;
  plan.reference = 50.0;
  return fit_series(series, plan, 1);
}

TEST(FunctionFitTest, WidenedIntervalsHoldNothingThatCannotBe) {
  for (const auto& right :
       {std::array{23, 16, 21, 23, 32, 32}, std::array{16, 16, 24, 20, 29, 29}}) {
    const FunctionFit fit = fit_of(right);
    ASSERT_TRUE(fit.stated);
    ASSERT_THAT(fit.warnings, Contains(HasSubstr("times as long as chance alone")));
    const FunctionReadings& r = *fit.stated;
    EXPECT_GT(r.slope.low, 0.0) << "the function rises";
    EXPECT_LT(r.slope.low, r.slope.value);
    EXPECT_GT(r.slope.high, r.slope.value);
    EXPECT_GE(r.lapse.low, 0.0);
    EXPECT_LE(r.lapse.high, kMostLapses) << "the fit looked no further";
    EXPECT_GE(r.lapse.high, r.lapse.value);
  }
}

TEST(FunctionFitTest, ALapseRateAfterNoLapsesHasNoInterval) {
  const FunctionFit fit = fit_of({15, 15, 20, 25, 33, 33});
  ASSERT_TRUE(fit.stated);
  EXPECT_NEAR(fit.stated->lapse.value, 0.0, 1e-6);
  EXPECT_TRUE(std::isnan(fit.stated->lapse.low) && std::isnan(fit.stated->lapse.high))
      << "33 of 33 right answers leave room for lapses of some percent";
  EXPECT_GT(fit.stated->slope.low, 0.0);
}

}  // namespace
}  // namespace haptrial::analysis::trials
