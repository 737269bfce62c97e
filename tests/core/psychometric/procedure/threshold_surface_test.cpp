#include "core/psychometric/procedure/threshold_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/random.h"
#include "core/psychometric/function/sigmoid.h"
#include "tests/support/message_of.h"

namespace haptrial::psychometric::threshold_surface_test {
namespace {

using testing::HasSubstr;

// --- one belief ---------------------------------------------------------------------------------

struct Fact {
  Eigen::Vector2d row;
  ProbitLink link;
};

struct Moments {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
};

/// The posterior of two coefficients summed over a fine grid.
Moments summed(const Eigen::Vector2d& deviations, const std::vector<Fact>& facts) {
  double all = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (double a = -6.0; a <= 6.0; a += 0.02) {
    for (double b = -6.0; b <= 6.0; b += 0.02) {
      const Eigen::Vector2d w(a * deviations[0], b * deviations[1]);
      double p = std::exp(-0.5 * (a * a + b * b));
      for (const Fact& fact : facts) {
        p *= fact.link.floor +
             fact.link.share * 0.5 *
                 std::erfc(-fact.link.sign * fact.row.dot(w) / std::numbers::sqrt2);
      }
      all += p;
      first += p * w;
      second += p * w * w.transpose();
    }
  }
  first /= all;
  return {first, second / all - first * first.transpose()};
}

TEST(SmoothBeliefTest, IsThePosteriorAsASumOverAGridHasIt) {
  const Eigen::Vector2d deviations(1.5, 1.0);
  const std::vector<Fact> facts{{{1.0, -0.5}, {0.0, 0.98, 1.0}},
                                {{1.0, 0.8}, {0.02, 0.98, -1.0}},
                                {{1.0, 0.2}, {0.0, 0.98, 1.0}},
                                {{0.5, -1.0}, {0.5, 0.48, 1.0}},
                                {{0.0, 2.0}, {}}};
  SmoothBelief belief(deviations);
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = 0; i < facts.size(); ++i) {
      belief.visit(i, facts[i].row, facts[i].link);
    }
  }
  const Moments truth = summed(deviations, facts);
  EXPECT_LT((belief.mean() - truth.mean).norm(), 0.05);
  EXPECT_LT((belief.covariance() - truth.covariance).norm(), 0.15) << "of 3 before the facts";
}

TEST(SmoothBeliefTest, OneFactIsExact) {
  SmoothBelief belief(Eigen::Vector2d(1.0, 2.0));
  const Fact fact{{0.7, 0.4}, {0.1, 0.85, 1.0}};
  const double probability = belief.visit(0, fact.row, fact.link).probability;
  EXPECT_NEAR(probability, 0.1 + 0.85 * 0.5, 1e-12) << "nothing is known before";
  const Moments truth = summed({1.0, 2.0}, {fact});
  EXPECT_LT((belief.mean() - truth.mean).norm(), 1e-4);
  EXPECT_LT((belief.covariance() - truth.covariance).norm(), 1e-3);
}

TEST(SmoothBasisTest, SlopesAreDerivatives) {
  const SmoothBasis basis(3);
  const std::vector<double> u{0.2, -0.6, 0.5};
  constexpr double kStep = 1e-6;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> to = u;
    to[k] += kStep;
    const Eigen::VectorXd difference = (basis.at(to) - basis.at(u)) / kStep;
    EXPECT_LT((difference - basis.slope(u, k)).norm(), 1e-4);
  }
}

/// The sum of all sines, with their deviations, has the covariance of the Gaussian process.
TEST(SmoothBasisTest, TheCovarianceIsTheSquaredExponential) {
  const SmoothBasis basis(2);
  const Smoothness smoothness{1.0, 1.0, 0.7};
  Eigen::VectorXd deviations = basis.deviations(smoothness);
  deviations.head<3>().setZero();  // 1 and the straight slopes
  const auto covariance = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return basis.at(a).cwiseProduct(deviations).dot(basis.at(b).cwiseProduct(deviations));
  };
  EXPECT_NEAR(covariance({0.0, 0.0}, {0.0, 0.0}), 1.0, 0.1);
  EXPECT_NEAR(covariance({0.3, 0.0}, {-0.3, 0.2}), std::exp(-0.5 * (0.36 + 0.04) / (0.7 * 0.7)),
              0.1);
}

// --- the procedure ------------------------------------------------------------------------------

std::vector<double> even(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(from + (to - from) * i / (count - 1));
  }
  return values;
}

SurfaceParameters plane(int trials) {
  SurfaceParameters p;
  p.variables = {{"a", even(0.0, 1.0, 21), true}, {"b", even(0.0, 10.0, 9), false}};
  p.target = 0.5;
  p.trials = trials;
  return p;
}

constexpr double kSpread = 0.1;

/// A bent threshold of a over b.
double threshold_at(double b) {
  return 0.3 + 0.03 * b + 0.1 * std::sin(0.1 * std::numbers::pi * b);
}

bool answer_at(const Level& level, RandomStream& random) {
  const double z = (level[0] - threshold_at(level[1])) / kSpread;
  return random.uniform() < 0.98 * sigmoid(Sigmoid::kGaussian, z);
}

/// The target of 0.5 lies a little above the middle of a function that ends at 0.98.
constexpr double kAbove = 0.02558 * kSpread;

TEST(ThresholdSurfaceTest, FindsABentThresholdWithinItsIntervals) {
  constexpr int kObservers = 12, kTrials = 100;
  int held = 0, told = 0;
  double error = 0.0;
  for (int observer = 0; observer < kObservers; ++observer) {
    RandomStream random(static_cast<std::uint64_t>(observer), "surface answers");
    ThresholdSurface surface(plane(kTrials));
    while (!surface.finished()) {
      const Level level = surface.next();
      surface.report(answer_at(level, random) ? 1.0 : 0.0, level);
    }
    const std::vector<Level> others{{0.0}, {2.5}, {5.0}, {7.5}, {10.0}};
    const auto found = surface.thresholds(others);
    for (std::size_t i = 0; i < others.size(); ++i) {
      const double truth = threshold_at(others[i][0]) + kAbove;
      held += found[i].low <= truth && truth <= found[i].high ? 1 : 0;
      error += std::abs(found[i].median - truth);
      ++told;
    }
  }
  EXPECT_GE(held, told - 9) << "60 intervals of 95 %, those of an observer not independent";
  EXPECT_LT(error / told, 0.3 * kSpread);
}

TEST(ThresholdSurfaceTest, EstimatesNameWhereTheyAre) {
  ThresholdSurface surface(plane(30));
  EXPECT_THAT(surface.estimates(), testing::IsEmpty());
  RandomStream random(7, "surface answers");
  for (int i = 0; i < 20; ++i) {
    const Level level = surface.next();
    surface.report(answer_at(level, random) ? 1.0 : 0.0, level);
  }
  const auto estimates = surface.estimates();
  ASSERT_EQ(estimates.size(), 5u);
  EXPECT_EQ(estimates[2].name, "threshold of a at b 5");
  EXPECT_LT(estimates[2].interval->low, estimates[2].value);
  EXPECT_GT(estimates[2].interval->high, estimates[2].value);
}

TEST(ThresholdSurfaceTest, FollowsFromTheOutcomesAlone) {
  ThresholdSurface first(plane(40));
  RandomStream random(3, "surface answers");
  std::vector<Outcome> outcomes;
  for (int i = 0; i < 25; ++i) {
    Level level = first.next();
    level[0] += 0.007;  // as a device rounds it
    outcomes.push_back({answer_at(level, random) ? 1.0 : 0.0, level});
    first.report(outcomes.back().answer, level);
  }
  ThresholdSurface second(plane(40));
  replay(second, outcomes);
  EXPECT_EQ(second.next(), first.next());
  EXPECT_EQ(second.estimates()[1].value, first.estimates()[1].value);
}

/// Whoever always says yes has a threshold below all levels, and one who never does above them.
TEST(ThresholdSurfaceTest, AThresholdBeyondTheLevelsIsOpen) {
  for (const double answer : {0.0, 1.0}) {
    ThresholdSurface surface(plane(40));
    while (!surface.finished()) {
      surface.report(answer, surface.next());
    }
    for (const Estimate& each : surface.estimates()) {
      EXPECT_EQ(each.remark, "beyond its levels");
      EXPECT_EQ(each.value, answer == 1.0 ? 0.0 : 1.0);
      EXPECT_EQ(std::isinf(each.interval->low), answer == 1.0);
      EXPECT_EQ(std::isinf(each.interval->high), answer == 0.0);
    }
  }
}

TEST(ThresholdSurfaceTest, PresentsOnlyWhatADeviceCan) {
  SurfaceParameters p = plane(30);
  p.allowed = [](const Level& level) { return level[0] + 0.1 * level[1] <= 0.8; };
  ThresholdSurface surface(p);
  RandomStream random(5, "surface answers");
  while (!surface.finished()) {
    const Level level = surface.next();
    EXPECT_TRUE(p.allowed(level));
    surface.report(answer_at(level, random) ? 1.0 : 0.0, level);
  }
}

/// With four variables, of which further ones rise: the threshold of the first falls over them.
TEST(ThresholdSurfaceTest, FourVariablesThatRise) {
  SurfaceParameters p;
  for (const char* name : {"a", "b", "c", "d"}) {
    p.variables.push_back({name, even(0.0, 1.0, 6), true});
  }
  p.target = 0.5;
  p.trials = 60;
  ThresholdSurface surface(p);
  RandomStream random(9, "surface answers");
  while (!surface.finished()) {
    const Level level = surface.next();
    const double z = (level[0] + 0.3 * (level[1] + level[2] + level[3]) - 0.8) / 0.15;
    surface.report(random.uniform() < sigmoid(Sigmoid::kGaussian, z) ? 1.0 : 0.0, level);
  }
  const auto found = surface.thresholds({{0.0, 0.5, 0.5}, {0.5, 0.5, 0.5}, {1.0, 0.5, 0.5}});
  EXPECT_GE(found[0].median, found[1].median);
  EXPECT_GE(found[1].median, found[2].median);
  EXPECT_NEAR(found[1].median, 0.8 - 0.45, 0.15);
}

TEST(ThresholdSurfaceTest, RefusesWhatItCannotDo) {
  const auto told = [](auto change) {
    return test::message_of<std::invalid_argument>([&] {
      SurfaceParameters p = plane(10);
      change(p);
      ThresholdSurface surface(p);
    });
  };
  EXPECT_THAT(told([](auto& p) { p.variables.clear(); }), HasSubstr("1 to 4"));
  EXPECT_THAT(told([](auto& p) { p.variables[0].levels = {1.0, 0.0}; }), HasSubstr("levels of a"));
  EXPECT_THAT(told([](auto& p) { p.guess = 0.5; }), HasSubstr("target"));
  EXPECT_THAT(told([](auto& p) { p.trials = 0; }), HasSubstr("trials"));
  EXPECT_THAT(told([](auto& p) { p.allowed = [](const Level&) { return false; }; }),
              HasSubstr("allowed"));
  ThresholdSurface surface(plane(10));
  EXPECT_THROW(surface.report(2.0, {0.5, 5.0}), std::invalid_argument);
  EXPECT_THROW(surface.report(1.0, {0.5}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric::threshold_surface_test
