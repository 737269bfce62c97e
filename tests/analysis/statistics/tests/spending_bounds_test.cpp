#include "analysis/statistics/tests/spending_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

struct JudgedBounds {
  Spending spending;
  bool two_sided;
  double error;
  std::vector<double> shares, bounds;
};

/// getDesignGroupSequential() of R's rpact 3.3.4; the first row stands in the literature, too
/// (Reboussin et al. 2000, Controlled Clinical Trials 21).
TEST(SpendingBoundsTest, AgreesWithRpact) {
  using enum Spending;
  const std::vector<JudgedBounds> judged{
      {kOBrienFleming,
       true,
       0.05,
       {0.2, 0.4, 0.6, 0.8, 1.0},
       {4.87688, 3.35701, 2.68028, 2.28982, 2.03103}},
      {kPocock,
       true,
       0.05,
       {0.2, 0.4, 0.6, 0.8, 1.0},
       {2.43798, 2.42681, 2.41019, 2.39665, 2.38598}},
      {kOBrienFleming, false, 0.05, {0.3, 0.5, 1.0}, {3.39295, 2.54535, 1.66230}},
      {kPocock, false, 0.05, {0.3, 0.5, 1.0}, {2.03776, 2.10506, 1.91260}},
      {kPocock, true, 0.05, {0.1, 0.9, 1.0}, {2.65511, 2.05537, 2.28309}},
      {kOBrienFleming,
       true,
       0.01,
       {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0},
       {0.0, 0.0, 4.99318, 4.28933, 3.81207, 3.46343, 3.19518, 2.98075, 2.80436, 2.65597}},
  };
  for (const JudgedBounds& each : judged) {
    const auto bounds = spending_bounds(each.shares, each.error, each.two_sided, each.spending);
    ASSERT_EQ(bounds.size(), each.bounds.size());
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      if (each.bounds[i] > 0.0) {  // rpact has no bound where ours lies beyond 6
        EXPECT_NEAR(bounds[i], each.bounds[i], each.error > 0.01 ? 1e-4 : 1e-3) << i;
      } else {
        EXPECT_GT(bounds[i], 6.0);
      }
    }
  }
}

TEST(SpendingBoundsTest, OneLookIsTheUsualTest) {
  const std::vector<double> whole{1.0};
  for (const Spending spending : {Spending::kOBrienFleming, Spending::kPocock}) {
    EXPECT_NEAR(spending_bounds(whole, 0.05, true, spending).front(), 1.959963985, 1e-8);
    EXPECT_NEAR(spending_bounds(whole, 0.05, false, spending).front(), 1.644853627, 1e-8);
  }
}

/// Counted: sums of normal values cross the bounds with the error that is stated.
TEST(SpendingBoundsTest, LooksHaveTheirErrorTogether) {
  constexpr int kStudies = 20'000, kLooks = 12;
  std::vector<double> shares;
  for (int i = 1; i <= kLooks; ++i) {
    shares.push_back(static_cast<double>(i) / kLooks);
  }
  for (const Spending spending : {Spending::kOBrienFleming, Spending::kPocock}) {
    const auto bounds = spending_bounds(shares, 0.05, true, spending);
    RandomStream random(1, "sums");
    int crossed = 0;
    for (int study = 0; study < kStudies; ++study) {
      double sum = 0.0;
      bool over = false;
      for (int i = 1; i <= kLooks; ++i) {
        sum += random.normal();
        over = over || std::abs(sum) / std::sqrt(i) >= bounds[static_cast<std::size_t>(i - 1)];
      }
      crossed += over ? 1 : 0;
    }
    EXPECT_NEAR(crossed, 1000, 95);  // 3 standard deviations
  }
}

TEST(SpendingBoundsTest, SharesOutsideOfTheirRangeAreRefused) {
  const std::vector<double> falls{0.5, 0.4}, beyond{0.5, 1.2};
  EXPECT_THROW(spending_bounds(falls, 0.05, true, Spending::kPocock), std::invalid_argument);
  EXPECT_THROW(spending_bounds(beyond, 0.05, true, Spending::kPocock), std::invalid_argument);
  EXPECT_THROW(spending_bounds(beyond, 0.6, true, Spending::kPocock), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
