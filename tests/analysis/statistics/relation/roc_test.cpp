#include "analysis/statistics/relation/roc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;
using Values = std::vector<double>;

// Positives 3, 1; negatives 2, 0: of four pairs three are right. Placements: positives 1 and 1/2,
// negatives 1/2 and 1; each kind has variance 1/8, so the area has 1/16 + 1/16.
TEST(Roc, MatchesACaseWorkedByHand) {
  const auto r = roc(Values{3, 1}, Values{2, 0});
  ASSERT_TRUE(r);
  EXPECT_DOUBLE_EQ(r->area, 0.75);
  EXPECT_NEAR(r->interval->error, std::sqrt(0.125), 1e-15);
  const std::vector<std::pair<double, double>> corners{
      {0, 0}, {0, 0.5}, {0.5, 0.5}, {0.5, 1}, {1, 1}};
  ASSERT_EQ(r->curve.size(), corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(r->curve[i].false_positives, corners[i].first);
    EXPECT_EQ(r->curve[i].true_positives, corners[i].second);
  }
  EXPECT_EQ(r->curve[1].threshold, 3.0);
}

// A tie between the kinds is a slope, and half a pair.
TEST(Roc, TiesCountHalf) {
  const auto r = roc(Values{2, 2, 3}, Values{2, 1});
  ASSERT_TRUE(r);
  EXPECT_DOUBLE_EQ(r->area, (0.5 + 1 + 0.5 + 1 + 1 + 1) / 6.0);
  ASSERT_EQ(r->curve.size(), 4u);
  EXPECT_DOUBLE_EQ(r->curve[2].false_positives, 0.5);
  EXPECT_DOUBLE_EQ(r->curve[2].true_positives, 1.0);
  EXPECT_DOUBLE_EQ(roc(Values{4, 4}, Values{4, 4})->area, 0.5);
}

// The area by the trapezium's rule is that of all pairs; turned round, the areas add up to 1.
TEST(Roc, AreaIsTheShareOfPairs) {
  RandomStream random(3, "roc");
  for (int run = 0; run < 50; ++run) {
    Values a, b, minus_a, minus_b;
    for (int i = 0; i < 9; ++i) {
      a.push_back(static_cast<double>(random.below(6)) + 1.0);
      minus_a.push_back(-a.back());
    }
    for (int i = 0; i < 7; ++i) {
      b.push_back(static_cast<double>(random.below(6)));
      minus_b.push_back(-b.back());
    }
    double pairs = 0.0;
    for (const double x : a) {
      for (const double y : b) {
        pairs += x > y ? 1.0 : x == y ? 0.5 : 0.0;
      }
    }
    const auto r = roc(a, b), turned = roc(minus_a, minus_b);
    EXPECT_NEAR(r->area, pairs / 63.0, 1e-14);
    EXPECT_NEAR(r->area + turned->area, 1.0, 1e-14);
    EXPECT_NEAR(r->interval->error, turned->interval->error, 1e-14);
  }
}

// Twice the same value from one participant is no more than once: area and error stay. As if they
// were independent the error would shrink.
TEST(Roc, RepeatsWithinAParticipantAddNothing) {
  const Values experts{5, 3, 4, 6}, novices{2, 4.5, 1, 3.5, 0};
  std::vector<RocCase> once, twice, independent;
  for (std::size_t i = 0; i < experts.size() + novices.size(); ++i) {
    const bool expert = i < experts.size();
    const double value = expert ? experts[i] : novices[i - experts.size()];
    once.push_back({value, expert, i});
    for (std::size_t again = 0; again < 2; ++again) {
      twice.push_back({value, expert, i});
      independent.push_back({value, expert, 2 * i + again});
    }
  }
  const auto a = roc(once), b = roc(twice), c = roc(independent);
  EXPECT_NEAR(a->area, b->area, 1e-15);
  EXPECT_NEAR(a->interval->error, b->interval->error, 1e-15);
  EXPECT_LT(c->interval->error, 0.8 * a->interval->error);
}

// Participants with their own level, four values each: 95 % intervals hold the true area about as
// often as they promise; those that take the values as independent do not.
TEST(Roc, ClusteredIntervalsHoldTheTrueArea) {
  RandomStream random(11, "roc clusters");
  const double truth = 0.5 * std::erfc(-1.0 / 2.0);  // N(1, 1) above N(0, 1): Phi(1 / sqrt 2)
  constexpr int kRuns = 400;
  int clustered = 0, independent = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<RocCase> cases, alone;
    for (std::size_t person = 0; person < 60; ++person) {
      const double level = std::sqrt(0.8) * random.normal();
      for (int k = 0; k < 4; ++k) {
        const bool positive = person < 30;
        const double value = (positive ? 1.0 : 0.0) + level + std::sqrt(0.2) * random.normal();
        cases.push_back({value, positive, person});
        alone.push_back({value, positive, alone.size()});
      }
    }
    const auto a = roc(cases)->interval, b = roc(alone)->interval;
    clustered += a->low <= truth && truth <= a->high ? 1 : 0;
    independent += b->low <= truth && truth <= b->high ? 1 : 0;
  }
  EXPECT_GT(clustered, 0.91 * kRuns);
  EXPECT_LT(independent, 0.85 * kRuns);
}

TEST(Roc, SaysWhyThereIsNone) {
  EXPECT_THAT(roc(Values{}, Values{1}).because(), HasSubstr("one kind"));
  EXPECT_THAT(roc(Values{std::numeric_limits<double>::quiet_NaN()}, Values{1}).because(),
              HasSubstr("finite"));
  const auto apart = roc(Values{5, 6}, Values{1, 2});
  EXPECT_EQ(apart->area, 1.0);
  EXPECT_THAT(apart->interval.because(), HasSubstr("without overlap"));
  EXPECT_THAT(roc(Values{1}, Values{1, 2})->interval.because(), HasSubstr("two of each"));
}

}  // namespace
}  // namespace haptrial::analysis
