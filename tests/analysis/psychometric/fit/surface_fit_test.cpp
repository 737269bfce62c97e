// Functions of several stimulus variables: the posterior against a law that has one, and virtual
// observers whose parameters are known.

#include "analysis/psychometric/fit/surface_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychometric/fit/contour.h"
#include "tests/analysis/psychometric/fit/surface_counts.h"
#include "tests/support/message_of.h"

namespace haptrial::analysis::surface_test {
namespace {

using psychometric::QuestDefinition;
using test::ellipse;

/// The answer 1 has the probability `rate`, whatever is presented.
QuestDefinition coin(std::vector<double> prior = {}) {
  QuestDefinition d;
  d.stimulus = {{"x", {0.0, 1.0}, {}, false}, {"y", {0.0, 1.0}, {}, false}};
  d.parameters = {{"rate", {0.0, 0.5, 1.0}, std::move(prior), false}};
  d.model = [](const double*, const double* rate, double* p) {
    p[1] = rate[0];
    p[0] = 1.0 - rate[0];
  };
  return d;
}

std::vector<SurfaceTrial> tosses(int ones, int zeros) {
  std::vector<SurfaceTrial> trials;
  for (int i = 0; i < ones + zeros; ++i) {
    trials.push_back({{0.1 * (i % 3), 0.0}, i < ones ? 1u : 0u});
  }
  return trials;
}

TEST(SurfaceFitTest, ACoinHasTheBetaDistribution) {
  for (const auto& [ones, zeros] : {std::pair(7, 13), {3, 0}, {160, 240}}) {
    const SurfaceFit fit = fit_surface(coin(), tosses(ones, zeros));
    ASSERT_EQ(fit.parameters.size(), 1u);
    const SurfaceParameter& rate = fit.parameters.front();
    const double a = ones + 1.0, b = zeros + 1.0;
    EXPECT_NEAR(rate.mean, a / (a + b), 2e-4);
    EXPECT_NEAR(rate.deviation, std::sqrt(a * b / (a + b + 1.0)) / (a + b), 2e-4);
    // The shares below both ends, by Simpson's rule over the density.
    const auto below = [a, b](double end) {
      double part = 0.0, all = 0.0;
      constexpr int kSteps = 20'000;
      for (int i = 0; i <= kSteps; ++i) {
        const double x = static_cast<double>(i) / kSteps;
        const double density = std::pow(x, a - 1.0) * std::pow(1.0 - x, b - 1.0);
        const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        all += weight * density;
        part += x <= end ? weight * density : 0.0;
      }
      return part / all;
    };
    EXPECT_NEAR(below(rate.low), 0.025, 1.5e-3);
    EXPECT_NEAR(below(rate.high), 0.975, 1.5e-3);
    EXPECT_EQ(rate.at_edge, zeros == 0);
  }
}

TEST(SurfaceFitTest, PriorsGoInStraightLinesBetweenTheListedValues) {
  // No answers but one of each: density ~ (1 - |2 x - 1|) x (1 - x) around 1/2.
  const SurfaceFit fit = fit_surface(coin({0.0, 1.0, 0.0}), tosses(1, 1));
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    const double x = (i + 0.5) / 10'000.0;
    const double density = (1.0 - std::abs(2.0 * x - 1.0)) * x * (1.0 - x);
    sum += density;
    square += density * (x - 0.5) * (x - 0.5);
  }
  EXPECT_NEAR(fit.parameters[0].mean, 0.5, 1e-4);
  EXPECT_NEAR(fit.parameters[0].deviation, std::sqrt(square / sum), 1e-4);
}

TEST(SurfaceFitTest, WhatCannotBeFittedIsSaidInASentence) {
  const auto refusal = [](const QuestDefinition& d, const std::vector<SurfaceTrial>& trials) {
    return test::message_of<std::invalid_argument>([&] { fit_surface(d, trials); });
  };
  EXPECT_EQ(refusal(coin(), {}), "there are no trials");
  EXPECT_THAT(refusal(coin(), {{{0.0}, 1}}),
              testing::HasSubstr("a trial has 1 stimulus variables"));
  QuestDefinition fixed = coin();
  fixed.parameters.front().values = {0.5};
  EXPECT_THAT(refusal(fixed, tosses(1, 1)), testing::HasSubstr("0 parameters have several values"));
  QuestDefinition impossible = coin();
  impossible.parameters.front().values = {0.0, 0.0};
  EXPECT_THAT(refusal(impossible, tosses(1, 1)), testing::HasSubstr("impossible for all values"));
}

TEST(SurfaceFitTest, IntervalsHoldTheTruthOfObserversDrawnFromThePrior) {
  const test::SurfaceCounts counts = test::count_surfaces(160, 1);
  constexpr int kLeast = 142, kMost = 159;  // 99.8 % of binomial counts of 160 at 0.95
  for (const int count : counts.held) {
    EXPECT_GE(count, kLeast);
    EXPECT_LE(count, kMost);
  }
  EXPECT_GT(counts.contours, 150);
  EXPECT_GE(counts.contours_held, counts.contours - 18);
  EXPECT_LT(counts.contours_held, counts.contours);
  EXPECT_NEAR(counts.error[0], 0.0, 0.02);
  EXPECT_NEAR(counts.error[1], 0.0, 0.02);
}

TEST(ThresholdMapTest, AKnownFunctionHasItsCircle) {
  SurfaceFit known;
  known.draws = {{1.0, 1.0, 0.2}};
  const ThresholdMap map(ellipse(), known, 0.5);
  for (const ContourPoint& point : map.points(9)) {
    if (point.first < 1.0) {
      ASSERT_EQ(point.second.size(), 1u) << point.first;
      EXPECT_NEAR(point.second.front(), std::sqrt(1.0 - point.first * point.first), 2e-3);
      EXPECT_NEAR(point.low, point.high, 1e-9) << "nothing is unsure";
    } else if (point.first > 1.0) {
      EXPECT_TRUE(point.second.empty());
    }
  }
  const Contour contour = map.contour();
  EXPECT_GT(contour.middle.size(), 20u);
  for (const auto& [from, to] : contour.middle) {
    EXPECT_NEAR(std::hypot(from.first, from.second), 1.0, 2e-3);
    EXPECT_NEAR(std::hypot(to.first, to.second), 1.0, 2e-3);
  }
  QuestDefinition three = ellipse();
  three.outcomes = 3;
  EXPECT_THAT(test::message_of<std::invalid_argument>([&] { ThresholdMap(three, known, 0.5); }),
              testing::HasSubstr("of two variables"));
}

}  // namespace
}  // namespace haptrial::analysis::surface_test
