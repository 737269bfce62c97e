// Every pattern, band, open end and power: the least cost, and the laws that hold for any curves.

#include "analysis/alignment/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/analysis/alignment/search.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::analysis::options_test {
namespace {

using test::Curve;
using test::exact_curve;
using test::smooth_curve;
using testing::HasSubstr;

constexpr StepPattern kPatterns[] = {StepPattern::kPublished, StepPattern::kSymmetric1,
                                     StepPattern::kSymmetric2, StepPattern::kAsymmetric,
                                     StepPattern::kSymmetricP1};

Alignment align(const Curve& a, const Curve& b, const AlignmentOptions& options) {
  return analysis::align(a.view(), b.view(), options);
}

/// The options of a pattern, all combinations of bands and open ends that make sense.
std::vector<AlignmentOptions> forms(StepPattern pattern, std::vector<std::size_t> windows) {
  std::vector<AlignmentOptions> all;
  for (int open = 0; open < 4; ++open) {
    AlignmentOptions form{.slope_weight = 0.25, .penalty = 0.5, .pattern = pattern};
    form.open_begin = open & 1;
    form.open_end = open & 2;
    if (!problem_of(form).empty()) {
      continue;
    }
    all.push_back(form);
    for (std::size_t window : windows) {
      form.window = window;
      all.push_back(form);
    }
  }
  return all;
}

std::string name(const AlignmentOptions& o) {
  return std::string(name_of(o.pattern)) + " p " + std::to_string(o.power) + " window " +
         (o.window ? std::to_string(*o.window) : "none") + (o.open_begin ? " open begin" : "") +
         (o.open_end ? " open end" : "");
}

TEST(AlignmentOptionsTest, CostIsTheLeastOverEveryLegalPath) {
  RandomStream random(1, "every form");
  int pathless = 0, found = 0;
  for (StepPattern pattern : kPatterns) {
    for (AlignmentOptions options : forms(pattern, {0, 1, 2, 4})) {
      for (double power : {1.0, 1.5, 1.7, 2.0, 3.0}) {
        for (int n = 0; n < 8; ++n) {
          options.power = power;
          options.penalty = static_cast<double>(random.below(6)) / 4.0;
          const Curve a = exact_curve(random, 1 + random.below(6));
          const Curve b = exact_curve(random, 1 + random.below(6));
          const double least = test::ExhaustiveSearch(a, b, options).cost();
          if (std::isinf(least)) {
            EXPECT_THROW(align(a, b, options), std::invalid_argument) << name(options);
            ++pathless;
            continue;
          }
          const Alignment best = align(a, b, options);
          const double rounding = power == 1.0 || power == 2.0 ? 0.0 : 1e-12 * least;
          EXPECT_NEAR(best.cost, least, rounding)
              << name(options) << ' ' << a.force.size() << 'x' << b.force.size();
          EXPECT_NEAR(test::cost_of_legal_path(a, b, options, best.path), best.cost, rounding)
              << name(options);
          ++found;
        }
      }
    }
  }
  EXPECT_GT(found, 1500);
  EXPECT_GT(pathless, 50);
}

TEST(AlignmentOptionsTest, PathsAreLegalAndInsideTheBand) {
  RandomStream random(2, "paths");
  for (StepPattern pattern : kPatterns) {
    for (AlignmentOptions options : forms(pattern, {0, 3, 20})) {
      options.power = 1.7;
      const Curve a = smooth_curve(random, 90 + random.below(20));
      const Curve b = smooth_curve(random, 90 + random.below(20));
      const Alignment found = align(a, b, options);
      EXPECT_NEAR(test::cost_of_legal_path(a, b, options, found.path), found.cost,
                  1e-12 * found.cost)
          << name(options);
      const double rows = static_cast<double>(a.force.size() - 1);
      const double columns = static_cast<double>(b.force.size() - 1);
      for (const PathPoint& at : found.path) {
        const double apart =
            std::max(rows, columns) * std::abs(at.target / rows - at.applied / columns);
        // Half a sample of the shorter curve is up to 0.61 of the longer one.
        EXPECT_LE(apart, options.window
                             ? std::max(0.62, static_cast<double>(*options.window)) + 1e-9
                             : 200.0)
            << name(options);
      }
    }
  }
}

TEST(AlignmentOptionsTest, ACurveAgainstItselfCostsNothing) {
  RandomStream random(3, "identity");
  for (StepPattern pattern : kPatterns) {
    for (AlignmentOptions options : forms(pattern, {0, 5})) {
      options.power = 1.25;
      const Curve a = smooth_curve(random, 70);
      const Alignment found = align(a, a, options);
      EXPECT_EQ(found.cost, 0.0) << name(options);
      EXPECT_EQ(found.path.size(), 70u) << name(options);
      EXPECT_EQ(found.path.front(), (PathPoint{0, 0})) << name(options);
      EXPECT_EQ(found.path.back(), (PathPoint{69, 69})) << name(options);
    }
  }
}

TEST(AlignmentOptionsTest, SwappingTheCurvesKeepsTheCostOfSymmetricForms) {
  RandomStream random(4, "swap");
  for (StepPattern pattern : kPatterns) {
    if (pattern == StepPattern::kAsymmetric) {
      continue;
    }
    for (const AlignmentOptions& options : forms(pattern, {0, 2, 9})) {
      if (options.open_begin || options.open_end) {
        continue;
      }
      for (int n = 0; n < 10; ++n) {
        const Curve a = exact_curve(random, 30 + random.below(20));
        const Curve b = exact_curve(random, 30 + random.below(20));
        EXPECT_EQ(align(a, b, options).cost, align(b, a, options).cost) << name(options);
      }
    }
  }
}

/// Quantity that an alignment makes least: see ExhaustiveSearch::cost().
double measure(const Alignment& found, const AlignmentOptions& options) {
  const std::uint32_t paired = found.path.back().target + found.path.back().applied + 2;
  return options.open_end && doubles_straight(options.pattern) ? found.cost / paired : found.cost;
}

TEST(AlignmentOptionsTest, AWiderWindowNeverCostsMore) {
  RandomStream random(5, "wider");
  for (StepPattern pattern : kPatterns) {
    for (const AlignmentOptions& form : forms(pattern, {})) {
      const Curve a = exact_curve(random, 45), b = exact_curve(random, 40 + random.below(20));
      double narrower = std::numeric_limits<double>::infinity();
      bool gained = false;
      for (std::size_t window : {0u, 1u, 2u, 3u, 5u, 8u, 13u, 30u, 60u}) {
        AlignmentOptions options = form;
        options.window = window;
        const double cost = measure(align(a, b, options), options);
        EXPECT_LE(cost, narrower) << name(options);
        gained = gained || cost < 0.8 * narrower;
        narrower = cost;
      }
      EXPECT_EQ(narrower, measure(align(a, b, form), form)) << name(form) << " and no window";
      EXPECT_TRUE(gained) << name(form) << ": the window made no difference";
    }
  }
}

TEST(AlignmentOptionsTest, OpenEndsNeverCostMore) {
  RandomStream random(6, "open");
  for (StepPattern pattern : kPatterns) {
    for (const AlignmentOptions& form : forms(pattern, {4})) {
      AlignmentOptions closed = form;
      closed.open_begin = closed.open_end = false;
      for (int n = 0; n < 10; ++n) {
        const Curve a = exact_curve(random, 25), b = exact_curve(random, 25 + random.below(10));
        EXPECT_LE(align(a, b, form).cost, align(a, b, closed).cost) << name(form);
      }
    }
  }
}

TEST(AlignmentOptionsTest, OpenEndsFindACurveWithinALongerOne) {
  RandomStream random(7, "subsequence");
  const Curve whole = smooth_curve(random, 200);
  Curve part;
  for (std::size_t i = 60; i < 140; ++i) {
    part.force.push_back(whole.force[i]);
    part.slope.push_back(whole.slope[i]);
  }
  for (StepPattern pattern :
       {StepPattern::kPublished, StepPattern::kSymmetric1, StepPattern::kAsymmetric}) {
    AlignmentOptions options{.pattern = pattern};
    options.open_begin = options.open_end = true;
    const Alignment found = align(part, whole, options);
    EXPECT_EQ(found.cost, 0.0);
    EXPECT_EQ(found.path.front(), (PathPoint{0, 60}));
    EXPECT_EQ(found.path.back(), (PathPoint{79, 139}));
  }
}

TEST(AlignmentOptionsTest, TheBandAlwaysLeavesAPath) {
  RandomStream random(8, "band");
  for (std::size_t rows = 1; rows <= 13; ++rows) {
    for (std::size_t columns = 1; columns <= 13; ++columns) {
      const Curve a = exact_curve(random, rows), b = exact_curve(random, columns);
      for (StepPattern pattern : kPatterns) {
        // Only the slopes that a pattern allows can leave none, and no band makes that worse.
        const bool too_long = columns - 1 > 2 * (rows - 1),
                   too_short = rows - 1 > 2 * (columns - 1);
        const bool has_path = pattern == StepPattern::kAsymmetric    ? !too_long
                              : pattern == StepPattern::kSymmetricP1 ? !too_long && !too_short
                                                                     : true;
        AlignmentOptions options{.pattern = pattern};
        for (std::size_t window : {0u, 1u, 3u}) {
          options.window = window;
          if (has_path) {
            EXPECT_NO_THROW(align(a, b, options)) << name(options) << rows << 'x' << columns;
          } else {
            EXPECT_THROW(align(a, b, options), std::invalid_argument) << name(options);
          }
        }
      }
    }
  }
}

TEST(AlignmentOptionsTest, RowsAndVectorLanesGiveTheSame) {
  RandomStream random(9, "rows and lanes");
  for (StepPattern pattern :
       {StepPattern::kPublished, StepPattern::kSymmetric1, StepPattern::kSymmetric2}) {
    for (int n = 0; n < 20; ++n) {
      const Curve a = exact_curve(random, 1 + random.below(300));
      const Curve b = exact_curve(random, 1 + random.below(300));
      AlignmentOptions by_lanes{.slope_weight = 0.25, .penalty = n % 3 / 2.0, .power = 1.0 + n % 2};
      by_lanes.pattern = pattern;
      AlignmentOptions by_rows = by_lanes;
      by_rows.window = 300;  // shuts nothing out
      ASSERT_TRUE(is_vectorized(by_lanes) && !is_vectorized(by_rows));
      const Alignment lanes = align(a, b, by_lanes), rows = align(a, b, by_rows);
      EXPECT_EQ(lanes.cost, rows.cost) << name(by_lanes);
      EXPECT_EQ(lanes.path, rows.path) << name(by_lanes);
      EXPECT_EQ(lanes.weight, rows.weight) << name(by_lanes);
    }
  }
}

TEST(AlignmentOptionsTest, WeightsAddUpAsTheLiteratureNormalizes) {
  RandomStream random(10, "weights");
  const Curve a = smooth_curve(random, 60), b = smooth_curve(random, 75);
  const auto weight = [&](StepPattern pattern) {
    return align(a, b, AlignmentOptions{.pattern = pattern}).weight;
  };
  EXPECT_EQ(weight(StepPattern::kSymmetric2), 60.0 + 75.0 - 1.0);  // the first pair counts once
  EXPECT_EQ(weight(StepPattern::kSymmetricP1), 60.0 + 75.0 - 1.0);
  EXPECT_EQ(weight(StepPattern::kAsymmetric), 60.0);
  const Alignment published = align(a, b, AlignmentOptions{});
  EXPECT_EQ(published.weight, static_cast<double>(published.path.size()));
}

TEST(AlignmentOptionsTest, ABatchOfAnyFormEqualsSinglePairsWhateverTheJobs) {
  RandomStream random(11, "batch");
  std::vector<Curve> curves;
  for (int k = 0; k < 40; ++k) {
    curves.push_back(smooth_curve(random, 50 + random.below(30)));
  }
  std::vector<AlignmentPair> pairs;
  for (std::size_t k = 0; k < 40; k += 2) {
    pairs.push_back({curves[k].view(), curves[k + 1].view()});
  }
  for (StepPattern pattern : kPatterns) {
    for (const AlignmentOptions& options : forms(pattern, {7})) {
      const auto one = align_batch(pairs, options, 1), three = align_batch(pairs, options, 3);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const Alignment single = align(curves[2 * k], curves[2 * k + 1], options);
        EXPECT_EQ(one[k].cost, single.cost) << name(options);
        EXPECT_EQ(one[k].path, single.path) << name(options);
        EXPECT_EQ(three[k].path, single.path) << name(options);
      }
    }
  }
  EXPECT_THROW(align_batch(pairs, {}, 0), std::invalid_argument);
}

TEST(AlignmentOptionsTest, NothingIsAllocatedAfterTheFirstUse) {
  RandomStream random(12, "allocation");
  const Curve a = smooth_curve(random, 120), b = smooth_curve(random, 130);
  for (StepPattern pattern : kPatterns) {
    for (AlignmentOptions options : forms(pattern, {9})) {
      options.power = 1.5;
      Aligner aligner;
      Alignment result;
      aligner.align(a.view(), b.view(), options, result);
      const haptrial::test::AllocationGuard guard;
      aligner.align(a.view(), b.view(), options, result);
      EXPECT_EQ(guard.count(), 0u) << name(options);
    }
  }
}

TEST(AlignmentOptionsTest, ProblemsAreSentences) {
  EXPECT_EQ(problem_of({}), "");
  EXPECT_EQ(problem_of({.power = 0.5}), "power is 0.5; allowed: a number from 1 to 100");
  EXPECT_THAT(problem_of({.penalty = -1.0}), HasSubstr("penalty is -1; allowed"));
  EXPECT_THAT(problem_of({.force_weight = std::nan("")}), HasSubstr("force_weight is nan"));
  for (StepPattern pattern : {StepPattern::kSymmetric2, StepPattern::kSymmetricP1}) {
    AlignmentOptions options{.pattern = pattern};
    options.open_begin = true;
    EXPECT_THAT(problem_of(options), HasSubstr("open_begin is true with the pattern symmetric"));
    const Curve curve{{1.0, 2.0}, {0.0, 1.0}};
    EXPECT_THROW(align(curve, curve, options), std::invalid_argument);
  }
  for (StepPattern pattern : kPatterns) {
    EXPECT_EQ(pattern_of(name_of(pattern)), pattern);
  }
  EXPECT_EQ(pattern_of("symmetric3"), std::nullopt);
}

TEST(AlignmentOptionsTest, LargeValuesAreRefusedInEveryForm) {
  const Curve good{{1.0, 2.0}, {0.0, 1.0}};
  for (double bad : {1e13, -1e13, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const Curve curve{{1.0, bad}, {0.0, 0.0}};
    EXPECT_THROW(align(curve, good, {.power = 1.5}), std::invalid_argument) << bad;
    EXPECT_THROW(align(good, curve, {.pattern = StepPattern::kAsymmetric}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace haptrial::analysis::options_test
