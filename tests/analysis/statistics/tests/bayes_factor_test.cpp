#include "analysis/statistics/tests/bayes_factor.h"

#include <gsl/gsl_randist.h>
#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::analysis {
namespace {

struct Judged {
  double t, df, n;
  double two, less, greater;
};

/// ttest.tstat() of R's BayesFactor 0.9.12-4.4 with rscale = sqrt(2) / 2, and nullInterval for
/// directed tests; cases in which it approximates nothing.
constexpr Judged kJudged[] = {
    {2.2, 11, 12, 1.65605931, 0.112399462, 3.19971917},
    {0.3, 11, 12, 0.29882692, 0.23454233, 0.363111509},
    {-2.5, 19, 20, 2.70214516, 5.32594102, 0.0783493127},
    {5, 29, 30, 901.586491, 0.0419792279, 1803.131},
    {0, 99, 100, 0.110704638, 0.110704638, 0.110704638},
    {-1.1, 38, 10, 0.498316141, 0.830339181, 0.166293102},
    {3.1, 22, 6, 8.37423882, 0.120755104, 16.6277225},
    {1.7, 21, 120.0 / 23.0, 1.05441113, 0.178063396, 1.93075886},
};

TEST(BayesFactorTest, AgreesWithBayesFactorOfR) {
  for (const Judged& each : kJudged) {
    const auto of = [&](Tail tail) { return *bayes_factor(each.t, each.df, each.n, tail); };
    EXPECT_NEAR(of(Tail::kTwoSided) / each.two, 1.0, 1e-6) << each.t;
    EXPECT_NEAR(of(Tail::kLess) / each.less, 1.0, 1e-6) << each.t;
    EXPECT_NEAR(of(Tail::kGreater) / each.greater, 1.0, 1e-6) << each.t;
  }
}

/// Data without an effect favour one on average by 1, whatever is asked.
TEST(BayesFactorTest, ItsMeanWithoutAnEffectIsOne) {
  for (const Tail tail : {Tail::kTwoSided, Tail::kLess, Tail::kGreater}) {
    double mean = 0.0;
    constexpr double kStep = 0.05;
    for (double t = -60.0; t <= 60.0; t += kStep) {
      mean += kStep * gsl_ran_tdist_pdf(t, 15.0) * *bayes_factor(t, 15.0, 16.0, tail);
    }
    // What lies beyond is the share of the prior with effects above 15.
    EXPECT_NEAR(mean, 1.0, 0.05);
    EXPECT_LT(mean, 1.0);
  }
}

TEST(BayesFactorTest, LargeEffectsDoNotOverflow) {
  EXPECT_GT(*bayes_factor(300.0, 15.0, 16.0, Tail::kTwoSided), 1e20);
  EXPECT_LT(*bayes_factor(300.0, 15.0, 16.0, Tail::kLess), 0.1);
}

}  // namespace
}  // namespace haptrial::analysis
