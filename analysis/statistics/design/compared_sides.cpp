#include "analysis/statistics/design/compared_sides.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/covariate_tests.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {
namespace {

bool equally_large(const Sides& sides) {
  const auto& [a, b] = sides.strata.begin()->second;
  return std::all_of(sides.strata.begin(), sides.strata.end(), [&](const auto& stratum) {
    return stratum.second.first.size() == a.size() && stratum.second.second.size() == b.size();
  });
}

/// Ranks, permutations and the bootstrap take the values of a side together. That holds within
/// people, where equally large groups are weighed alike; between people the difference of the
/// groups would count as their spread.
bool can_be_pooled(const Sides& sides) {
  return sides.strata.size() < 2 || (sides.paired && equally_large(sides));
}

/// The values of each stratum and side; differences alone where they are paired.
struct Strata {
  explicit Strata(const Sides& sides) {
    for (const auto& [key, values] : sides.strata) {
      const auto& [first, second] = values;
      a.push_back(first);
      if (!sides.paired) {
        b.push_back(second);
        continue;
      }
      std::transform(first.begin(), first.end(), second.begin(), a.back().begin(), std::minus<>{});
    }
  }

  std::vector<std::vector<double>> a, b;
};

void compare_means(SideTest& test, const Sides& values) {
  const Tail tail = test.sides.tail;
  if (values.strata.size() > 1) {
    const Strata strata(values);
    test.t = stratified_t_test(strata.a, strata.b, tail);
    test.size = stratified_d(strata.a, strata.b);
  } else if (values.paired) {
    test.t = paired_t_test(values.a, values.b, tail);
    test.size = cohens_dz(values.a, values.b);
  } else {
    test.t = welch_t_test(values.a, values.b, tail);
    test.size = cohens_d(values.a, values.b);
  }
}

/// The factor of a difference that is the same in all strata, by the t of an analysis of variance
/// of stratum and side without interaction. Strata that have one side so far tell the variance
/// alone, so that the order in which groups come does not matter.
Defined<double> common_bayes_factor(const Sides& values, Tail tail) {
  double weights = 0.0, sum = 0.0, squares = 0.0, df = -1.0;
  for (const auto& [stratum, sides] : values.strata) {
    const auto a = moments(sides.first), b = moments(sides.second);
    const double n_a = a ? static_cast<double>(a->count) : 0.0;
    const double n_b = b ? static_cast<double>(b->count) : 0.0;
    squares += (a ? a->squares : 0.0) + (b ? b->squares : 0.0);
    df += n_a + n_b - 1.0;
    if (a && b) {
      const double weight = n_a * n_b / (n_a + n_b), difference = mean_difference(*a, *b);
      weights += weight;
      sum += weight * difference;
      squares += weight * difference * difference;
    }
  }
  squares -= weights > 0.0 ? sum * sum / weights : 0.0;
  if (!(weights > 0.0 && df > 0.0 && squares > 0.0)) {
    return Undefined{"no group has both sides, or the values do not vary within groups"};
  }
  return bayes_factor(sum / std::sqrt(weights * squares / df), df, weights, tail);
}

/// The factor of Student's test, which takes the variances of both sides to be alike.
Defined<double> bayes_factor_of(const Sides& values, Tail tail) {
  if (values.strata.size() > 1 && !values.paired) {
    return common_bayes_factor(values, tail);
  }
  const auto n_a = static_cast<double>(values.a.size()), n_b = static_cast<double>(values.b.size());
  const Defined<TTest> t = values.paired ? paired_t_test(values.a, values.b, tail)
                                         : student_t_test(values.a, values.b, tail);
  if (!t) {
    return Undefined{t.because()};
  }
  return bayes_factor(t->t, t->df, values.paired ? n_a : n_a * n_b / (n_a + n_b), tail);
}

Defined<TTest> trimmed_test_of(const Sides& values, double share, Tail tail) {
  if (values.strata.size() > 1) {
    return Undefined{"other groups lie across both sides"};
  }
  return values.paired ? paired_yuen_test(values.a, values.b, share, tail)
                       : yuen_test(values.a, values.b, share, tail);
}

void add_equivalence(SideTest& test) {
  if (test.beside.equivalence > 0.0) {
    test.equivalence =
        test.t ? Defined<EquivalenceTest>(equivalence_test(*test.t, test.beside.equivalence))
               : Undefined{test.t.because()};
  }
}

void resample(SideTest& test, const Sides& values, Resampling resampling) {
  const Tail tail = test.sides.tail;
  resampling.stream = "permutation of " + text_of(test.sides);
  test.permutation = test.paired ? sign_flip_test(values.a, values.b, tail, resampling)
                                 : permutation_test(values.a, values.b, tail, resampling);
  resampling.stream = "bootstrap of " + text_of(test.sides);
  if (!test.paired) {
    test.bootstrap = bootstrap_difference(values.a, values.b, resampling);
    return;
  }
  std::vector<double> differences(values.a.size());
  std::transform(values.a.begin(), values.a.end(), values.b.begin(), differences.begin(),
                 [](double a, double b) { return a - b; });
  test.bootstrap = bootstrap(
      differences,
      [](std::span<const double> drawn) {
        double sum = 0.0;
        for (const double value : drawn) {
          sum += value;
        }
        return sum / static_cast<double>(drawn.size());
      },
      resampling);
}

SideTest undefined_test(const PlannedTest& sides, const TestsBeside& beside,
                        const std::string& covariate, const Undefined& why) {
  SideTest test;
  test.sides = sides;
  test.beside = beside;
  test.covariate = covariate;
  test.t = why;
  test.size = why;
  test.ranks = why;
  test.permutation = why;
  test.bootstrap = why;
  if (beside.bayes_factors) {
    test.bayes_factor = why;
  }
  if (beside.equivalence > 0.0) {
    test.equivalence = why;
  }
  if (beside.trimmed > 0.0) {
    test.trimmed = why;
  }
  if (!covariate.empty()) {
    test.adjusted = why;
  }
  return test;
}

}  // namespace

std::string name_of_test(const SideTest& test) { return test.paired ? "paired t" : "Welch's t"; }

SideTest compared(const DesignTable& table, PlannedTest sides, const Cells& a, const Cells& b,
                  const Resampling& resampling, const TestsBeside& beside,
                  const Covariate& covariate) {
  if (const auto why = why_not_comparable(table, sides, a, b)) {
    return undefined_test(sides, beside, covariate.name, Undefined{*why});
  }
  const Sides values = values_of(table, a, b);
  SideTest test;
  test.sides = std::move(sides);
  test.paired = values.paired;
  test.count_a = values.a.size();
  test.count_b = values.b.size();
  const Tail tail = test.sides.tail;
  test.beside = beside;
  if (!covariate.name.empty()) {
    test.covariate = covariate.name;
    test.adjusted = adjusted_test(table, values, covariate, tail);
  }
  if (beside.bayes_factors) {
    test.bayes_factor = bayes_factor_of(values, tail);
  }
  if (beside.trimmed > 0.0) {
    test.trimmed = trimmed_test_of(values, beside.trimmed, tail);
  }
  compare_means(test, values);
  add_equivalence(test);
  if (!can_be_pooled(values)) {
    const Undefined why{"other groups lie across both sides"};
    test.ranks = why;
    test.permutation = why;
    test.bootstrap = why;
    return test;
  }
  test.ranks = values.paired ? wilcoxon_signed_rank(values.a, values.b, tail)
                             : mann_whitney(values.a, values.b, tail);
  if (resampling.count > 0) {
    resample(test, values, resampling);
  }
  return test;
}

namespace {

/// A participant under a combination of levels.
using Cell = std::pair<std::string, std::vector<std::string>>;

std::map<Cell, double> means_of(std::span<const Observation> observations) {
  std::map<Cell, std::pair<double, std::size_t>> sums;
  for (const Observation& each : observations) {
    auto& [sum, count] = sums[{each.subject, each.levels}];
    sum += each.value;
    ++count;
  }
  std::map<Cell, double> means;
  for (const auto& [cell, total] : sums) {
    means[cell] = total.first / static_cast<double>(total.second);
  }
  return means;
}

}  // namespace

std::vector<Observation> changes_from(std::span<const Observation> observations, std::size_t factor,
                                      const std::string& baseline) {
  const std::map<Cell, double> means = means_of(observations);
  std::vector<Observation> changes;
  for (const auto& [cell, mean] : means) {
    Cell before = cell;
    before.second.at(factor) = baseline;
    const auto at = means.find(before);
    if (cell != before && at != means.end()) {
      changes.push_back({cell.first, cell.second, mean - at->second});
    }
  }
  return changes;
}

}  // namespace haptrial::analysis
