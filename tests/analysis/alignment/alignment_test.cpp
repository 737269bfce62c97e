#include "analysis/alignment/alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/analysis/alignment/cases.h"

namespace haptrial::analysis::alignment_test {
namespace {

using test::Curve;
using test::exact_curve;
using test::kExact;
using test::smooth_curve;
using test::textbook_path;

Alignment align(const Curve& a, const Curve& b, const AlignmentOptions& p) {
  return analysis::align(a.view(), b.view(), p);
}

/// e(i,j), written from the formula and not from the code.
double point_error(const Curve& a, const Curve& b, const AlignmentOptions& p, std::size_t i,
                   std::size_t j) {
  return p.force_weight * std::pow(std::abs(a.force[i] - b.force[j]), p.power) +
         p.slope_weight * std::pow(std::abs(a.slope[i] - b.slope[j]), p.power);
}

/// The least cost over every monotone path from (i,j) to the end, by trying them all.
double exhaustive(const Curve& a, const Curve& b, const AlignmentOptions& p, std::size_t i = 0,
                  std::size_t j = 0) {
  const bool last_row = i + 1 == a.force.size(), last_column = j + 1 == b.force.size();
  double rest = last_row && last_column ? 0.0 : std::numeric_limits<double>::infinity();
  if (!last_row && !last_column) {
    rest = std::min(rest, exhaustive(a, b, p, i + 1, j + 1));
  }
  if (!last_row) {
    rest = std::min(rest, p.penalty + exhaustive(a, b, p, i + 1, j));
  }
  if (!last_column) {
    rest = std::min(rest, p.penalty + exhaustive(a, b, p, i, j + 1));
  }
  return point_error(a, b, p, i, j) + rest;
}

void expect_complete_path(const std::vector<PathPoint>& path, std::size_t rows,
                          std::size_t columns) {
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(path.front(), (PathPoint{0, 0}));
  EXPECT_EQ(path.back().target + 1, rows);
  EXPECT_EQ(path.back().applied + 1, columns);
  for (std::size_t k = 1; k < path.size(); ++k) {
    const auto down = path[k].target - path[k - 1].target;
    const auto across = path[k].applied - path[k - 1].applied;
    ASSERT_TRUE(down <= 1 && across <= 1 && down + across >= 1) << "step " << k;
  }
}

double recomputed_cost(const Curve& a, const Curve& b, const AlignmentOptions& p,
                       const std::vector<PathPoint>& path) {
  double cost = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    cost += point_error(a, b, p, path[k].target, path[k].applied);
    if (k > 0 && (path[k].target == path[k - 1].target || path[k].applied == path[k - 1].applied)) {
      cost += p.penalty;
    }
  }
  return cost;
}

TEST(AlignmentTest, CostIsTheLeastOverEveryPath) {
  RandomStream random(1, "exhaustive");
  for (double power : {1.0, 2.0}) {
    for (int n = 0; n < 300; ++n) {
      AlignmentOptions parameters = kExact;
      parameters.power = power;
      parameters.penalty = static_cast<double>(random.below(8)) / 4.0;
      const Curve a = exact_curve(random, 1 + random.below(6));
      const Curve b = exact_curve(random, 1 + random.below(6));
      EXPECT_EQ(align(a, b, parameters).cost, exhaustive(a, b, parameters)) << n << ' ' << power;
    }
  }
}

TEST(AlignmentTest, EqualsTheTextbookWhereSumsAreExact) {
  RandomStream random(2, "textbook");
  for (int n = 0; n < 60; ++n) {
    const Curve a = exact_curve(random, 1 + random.below(300));
    const Curve b = exact_curve(random, 1 + random.below(300));
    const Alignment found = align(a, b, kExact);
    EXPECT_EQ(found.path, textbook_path<double>(a, b, kExact));
    EXPECT_EQ(found.cost, recomputed_cost(a, b, kExact, found.path));
  }
}

TEST(AlignmentTest, EqualsTheTextbookInSinglePrecision) {
  RandomStream random(3, "single precision");
  for (int n = 0; n < 40; ++n) {
    AlignmentOptions parameters{.slope_weight = 0.37, .penalty = 0.05};
    parameters.power = 1.0 + n % 2;
    const Curve a = smooth_curve(random, 200 + random.below(300));
    const Curve b = smooth_curve(random, 200 + random.below(300));
    EXPECT_EQ(align(a, b, parameters).path, textbook_path<float>(a, b, parameters)) << n;
  }
}

/// Each e errs by at most u (2 S + 2 e) with S the largest |scaled force| + |scaled slope| of both
/// curves; each of the L - 1 sums and penalties by a relative u. So the search misjudges any path
/// by at most E = 2 L u S + 2 (L + 2) u C, and the path it takes is at most 2 E dearer than the
/// best.
TEST(AlignmentTest, SinglePrecisionStaysWithinItsBound) {
  RandomStream random(4, "bound");
  const AlignmentOptions parameters{.slope_weight = 0.37, .penalty = 0.05};
  for (int n = 0; n < 8; ++n) {
    const Curve a = smooth_curve(random, 1000), b = smooth_curve(random, 1000);
    const double best =
        path_cost(a.view(), b.view(), parameters, textbook_path<double>(a, b, parameters));
    double largest = 0.0;
    for (const Curve* curve : {&a, &b}) {
      double force = 0.0, slope = 0.0;
      for (std::size_t i = 0; i < curve->force.size(); ++i) {
        force = std::max(force, std::abs(parameters.force_weight * curve->force[i]));
        slope = std::max(slope, std::abs(parameters.slope_weight * curve->slope[i]));
      }
      largest += force + slope;
    }
    const double u = std::ldexp(1.0, -24), length = 1999.0;
    const double bound = 2.0 * (2.0 * length * u * largest + 2.0 * (length + 2.0) * u * best);
    const double cost = align(a, b, parameters).cost;
    EXPECT_GE(cost, best * (1.0 - 1e-12));
    EXPECT_LE(cost, best + bound);
    EXPECT_LT(bound, 0.01 * best);  // the bound says something
  }
}

TEST(AlignmentTest, ACurveAgainstItselfCostsNothing) {
  RandomStream random(5, "identity");
  for (std::size_t samples : {1u, 2u, 15u, 64u, 65u, 1000u}) {
    const Curve a = smooth_curve(random, samples);
    const Alignment found = align(a, a, AlignmentOptions{});
    EXPECT_EQ(found.cost, 0.0);
    ASSERT_EQ(found.path.size(), samples);
    for (std::uint32_t i = 0; i < samples; ++i) {
      EXPECT_EQ(found.path[i], (PathPoint{i, i}));
    }
  }
}

TEST(AlignmentTest, SwappingTheCurvesKeepsTheCost) {
  RandomStream random(6, "swap");
  for (int n = 0; n < 50; ++n) {
    const Curve a = exact_curve(random, 1 + random.below(150));
    const Curve b = exact_curve(random, 1 + random.below(150));
    EXPECT_EQ(align(a, b, kExact).cost, align(b, a, kExact).cost);
  }
}

TEST(AlignmentTest, ALargerPenaltyNeverLowersTheCost) {
  RandomStream random(7, "penalty");
  for (int n = 0; n < 20; ++n) {
    const Curve a = exact_curve(random, 80), b = exact_curve(random, 80);
    double previous = -1.0;
    for (double penalty : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 64.0}) {
      AlignmentOptions parameters = kExact;
      parameters.penalty = penalty;
      const Alignment found = align(a, b, parameters);
      EXPECT_GE(found.cost, previous);
      previous = found.cost;
      // Dearer than any error: no detour.
      EXPECT_TRUE(penalty < 64.0 || found.path.size() == 80u) << found.path.size();
    }
  }
}

TEST(AlignmentTest, PathIsMonotoneContiguousAndComplete) {
  RandomStream random(8, "path");
  for (auto [rows, columns] : {std::pair{1u, 1u},
                               {1u, 40u},
                               {40u, 1u},
                               {2u, 500u},
                               {500u, 2u},
                               {127u, 129u},
                               {128u, 128u},
                               {333u, 777u},
                               {1000u, 1000u}}) {
    const Curve a = smooth_curve(random, rows), b = smooth_curve(random, columns);
    const AlignmentOptions parameters{};
    const Alignment found = align(a, b, parameters);
    expect_complete_path(found.path, rows, columns);
    EXPECT_NEAR(found.cost, recomputed_cost(a, b, parameters, found.path), 1e-9 * found.cost);
    EXPECT_EQ(found.cost, path_cost(a.view(), b.view(), parameters, found.path));
  }
}

TEST(AlignmentTest, TiesGoStraightThenAlongTheTarget) {
  const Curve two{{1.0, 1.0}, {0.0, 0.0}};
  const Curve three{{1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}};
  AlignmentOptions free;
  free.penalty = 0.0;
  EXPECT_EQ(align(two, two, free).path, (std::vector<PathPoint>{{0, 0}, {1, 1}}));
  EXPECT_EQ(align(two, three, free).path, (std::vector<PathPoint>{{0, 0}, {0, 1}, {1, 2}}));
  // Straight through the middle costs 100; round either corner of it 25 + 25.
  const Curve peak{{0.0, 5.0, 0.0}, {0.0, 0.0, 0.0}}, trough{{0.0, -5.0, 0.0}, {0.0, 0.0, 0.0}};
  free.power = 2;
  EXPECT_EQ(align(peak, trough, free).path,
            (std::vector<PathPoint>{{0, 0}, {0, 1}, {1, 2}, {2, 2}}));
}

TEST(AlignmentTest, TiesEverywhereGoAsInTheTextbook) {
  RandomStream random(9, "ties");
  for (int n = 0; n < 100; ++n) {
    Curve a, b;
    for (Curve* curve : {&a, &b}) {
      const std::size_t samples = 1 + random.below(150);
      for (std::size_t i = 0; i < samples; ++i) {
        curve->force.push_back(static_cast<double>(random.below(3)));
        curve->slope.push_back(static_cast<double>(random.below(2)));
      }
    }
    const AlignmentOptions parameters{
        .slope_weight = 1.0, .penalty = static_cast<double>(n % 3), .power = 1.0 + n % 2};
    EXPECT_EQ(align(a, b, parameters).path, textbook_path<double>(a, b, parameters)) << n;
  }
}

TEST(AlignmentTest, NothingOutsideTheMatrixIsCheapForLargeValues) {
  RandomStream random(10, "large");
  const AlignmentOptions parameters{.penalty = std::ldexp(1.0, 34)};
  std::vector<Curve> curves(32);
  for (Curve& curve : curves) {
    curve.slope.assign(300, 0.0);
    for (int i = 0; i < 300; ++i) {
      curve.force.push_back(static_cast<double>(random.below(8)) * std::ldexp(1.0, 36));
    }
  }
  std::vector<AlignmentPair> pairs;
  for (std::size_t k = 0; k < 16; ++k) {
    pairs.push_back({curves[k].view(), curves[k + 16].view()});
  }
  const auto batch = align_batch(pairs, parameters);
  for (std::size_t k = 0; k < 16; ++k) {
    const auto expected = textbook_path<double>(curves[k], curves[k + 16], parameters);
    EXPECT_EQ(batch[k].path, expected) << k;
    EXPECT_EQ(align(curves[k], curves[k + 16], parameters).path, expected) << k;
  }
}

TEST(AlignmentTest, BadInputIsRefused) {
  const Curve good{{1.0, 2.0}, {0.0, 1.0}};
  const auto refused = [&](const Curve& a, const AlignmentOptions& p) {
    EXPECT_THROW(align(a, good, p), std::invalid_argument);
    EXPECT_THROW(align(good, a, p), std::invalid_argument);
  };
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  refused({}, {});
  refused({{1.0, 2.0}, {0.0}}, {});
  refused({{1.0, nan}, {0.0, 0.0}}, {});
  refused({{1.0, 2.0}, {0.0, infinity}}, {});
  refused({{1.0, -1e13}, {0.0, 0.0}}, {});
  refused(good, {.force_weight = -1.0});
  refused(good, {.slope_weight = nan});
  refused(good, {.penalty = infinity});
  refused(good, {.penalty = -0.1});
  refused(good, {.power = 0.5});
  refused(good, {.power = 101.0});
  refused(good, {.power = nan});
  const std::vector<double> many(Aligner::kMaxSamples + 1, 0.0);
  refused({many, many}, {});
}

}  // namespace
}  // namespace haptrial::analysis::alignment_test
