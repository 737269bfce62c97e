#include "analysis/statistics/relation/intraclass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using testing::HasSubstr;

MatrixXd classic_table() {
  MatrixXd ratings(6, 4);
  ratings << 9, 2, 5, 8,  //
      6, 1, 3, 2,         //
      8, 4, 6, 8,         //
      7, 1, 2, 6,         //
      10, 5, 6, 9,        //
      6, 2, 4, 7;
  return ratings;
}

// The table is that of Shrout and Fleiss 1979, tables 2 and 4.
TEST(Intraclass, GivesThePublishedTable) {
  const auto c = intraclass_correlation(classic_table());
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->mean_square_targets, 11.24, 0.005);
  EXPECT_NEAR(c->mean_square_within, 6.26, 0.005);
  EXPECT_NEAR(c->mean_square_raters, 32.49, 0.005);
  EXPECT_NEAR(c->mean_square_error, 1.02, 0.005);
  EXPECT_NEAR(c->one_way->value, 0.17, 0.005);
  EXPECT_NEAR(c->random_raters->value, 0.29, 0.005);
  EXPECT_NEAR(c->fixed_raters->value, 0.71, 0.005);
  EXPECT_NEAR(c->one_way_mean->value, 0.44, 0.005);
  EXPECT_NEAR(c->random_raters_mean->value, 0.62, 0.005);
  EXPECT_NEAR(c->fixed_raters_mean->value, 0.91, 0.005);
}

// Consistency forgives a rater who is severe throughout; agreement does not.
TEST(Intraclass, ARatersMeanCountsForAgreementOnly) {
  MatrixXd ratings = classic_table();
  const auto before = intraclass_correlation(ratings);
  ratings.col(1).array() -= 3.0;
  const auto after = intraclass_correlation(ratings);
  EXPECT_NEAR(after->fixed_raters->value, before->fixed_raters->value, 1e-12);
  EXPECT_NEAR(after->fixed_raters->low, before->fixed_raters->low, 1e-12);
  EXPECT_LT(after->random_raters->value, before->random_raters->value - 0.05);
  EXPECT_LT(after->one_way->value, before->one_way->value - 0.05);
}

// y = target + rater + error with known variances: forms (1) and (2) estimate the share of the
// targets, form (3) that without the raters.
TEST(Intraclass, RecoversVarianceComponentsOnAverage) {
  RandomStream random(7, "intraclass");
  constexpr int kRuns = 400;
  double two = 0.0, three = 0.0, covered = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    MatrixXd ratings(30, 6);
    Eigen::RowVectorXd raters(6);
    for (auto& r : raters) {
      r = 0.7 * random.normal();
    }
    for (auto row : ratings.rowwise()) {
      const double target = random.normal();
      for (Eigen::Index j = 0; j < row.size(); ++j) {
        row[j] = target + raters[j] + 0.5 * random.normal();
      }
    }
    const auto c = intraclass_correlation(ratings);
    two += c->random_raters->value / kRuns;
    three += c->fixed_raters->value / kRuns;
    covered += (c->fixed_raters->low < 0.8 && 0.8 < c->fixed_raters->high ? 1.0 : 0.0) / kRuns;
  }
  EXPECT_NEAR(two, 1.0 / (1.0 + 0.49 + 0.25), 0.03);
  EXPECT_NEAR(three, 1.0 / 1.25, 0.015);
  EXPECT_NEAR(covered, 0.95, 0.035);  // three standard errors
}

TEST(Intraclass, SaysWhyThereIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(intraclass_correlation(MatrixXd::Random(5, 1)).because(), HasSubstr("two raters"));
  EXPECT_THAT(intraclass_correlation(MatrixXd::Random(1, 5)).because(), HasSubstr("two targets"));
  EXPECT_THAT(intraclass_correlation(MatrixXd::Constant(4, 2, 3.0)).because(), HasSubstr("equal"));
  EXPECT_THAT(intraclass_correlation(MatrixXd::Constant(4, 2, nan)).because(),
              HasSubstr("not finite"));
}

TEST(Intraclass, ExactAgreementHasNoInterval) {
  MatrixXd ratings(4, 2);
  ratings << 1.1, 1.1, 2.3, 2.3, 4.7, 4.7, 5, 5;
  auto c = intraclass_correlation(ratings);
  ASSERT_TRUE(c);
  EXPECT_THAT(c->random_raters.because(), HasSubstr("agree exactly"));
  EXPECT_THAT(c->fixed_raters.because(), HasSubstr("agree exactly"));
  ratings.col(1).array() -= 1.0;
  c = intraclass_correlation(ratings);
  EXPECT_THAT(c->random_raters.because(), HasSubstr("by their means only"));
  EXPECT_TRUE(c->one_way);
}

// Raters in contrary order: below zero, yet a number, and never better than the interval's end.
TEST(Intraclass, MayBeNegative) {
  MatrixXd ratings(4, 2);
  ratings << 1, 5, 2, 4, 4, 2, 5, 1.5;
  const auto c = intraclass_correlation(ratings);
  EXPECT_LT(c->fixed_raters->value, -0.9);
  EXPECT_LE(c->fixed_raters->low, c->fixed_raters->value);
  EXPECT_GE(c->fixed_raters->high, c->fixed_raters->value);
  EXPECT_GT(c->fixed_raters->p, 0.9);
}

}  // namespace
}  // namespace haptrial::analysis
