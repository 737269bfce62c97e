#include "analysis/statistics/variance/factorial_anova.h"

#include <cmath>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/variance/within_effect.h"

namespace haptrial::analysis {
namespace {

/// The hypothesis that contrasts of the cells' means are 0: m' C (C' N^-1 C)^-1 C' m.
Defined<Anova> tested_contrasts(const Eigen::MatrixXd& contrasts, const Eigen::VectorXd& means,
                                const Eigen::VectorXd& counts, double squares_within,
                                double df_within) {
  const Eigen::VectorXd found = contrasts.transpose() * means;
  const Eigen::MatrixXd spread =
      contrasts.transpose() * counts.cwiseInverse().asDiagonal() * contrasts;
  Anova result;
  result.squares_between = found.dot(solve_pivoted(spread, found).solved);
  result.squares_within = squares_within;
  result.df_between = static_cast<double>(contrasts.cols());
  result.df_within = df_within;
  result.f = (result.squares_between / result.df_between) / (squares_within / df_within);
  if (!std::isfinite(result.f)) {
    return Undefined{kBeyondDouble};
  }
  result.p = f_upper_tail(result.f, result.df_between, result.df_within);
  result.eta_squared = result.squares_between / (result.squares_between + squares_within);
  return result;
}

}  // namespace

Defined<TwoWayAnova> two_way_anova(const std::vector<std::vector<double>>& cells,
                                   std::size_t levels_a) {
  if (levels_a == 0 || cells.size() % levels_a != 0) {
    throw std::invalid_argument("two_way_anova: the levels do not divide the cells");
  }
  const std::size_t levels_b = cells.size() / levels_a;
  if (levels_a < 2 || levels_b < 2) {
    return Undefined{"a factor has fewer than two levels"};
  }
  const auto count = static_cast<Eigen::Index>(cells.size());
  Eigen::VectorXd means(count);
  Eigen::VectorXd counts(count);
  double squares = 0.0;
  double df = 0.0;
  Moments first;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto m = moments(cells[static_cast<std::size_t>(i)]);
    if (!m) {
      return Undefined{cells[static_cast<std::size_t>(i)].empty() ? "a cell is empty"
                                                                  : m.because()};
    }
    first = i == 0 ? *m : first;
    means[i] = mean_difference(*m, first);
    counts[i] = static_cast<double>(m->count);
    squares += m->squares;
    df += counts[i] - 1.0;
  }
  if (df < 1.0) {
    return Undefined{"every cell has a single value"};
  }
  if (squares == 0.0) {
    return Undefined{"the values do not vary within any cell"};
  }
  const auto a = within::contrasts(levels_a);
  const auto b = within::contrasts(levels_b);
  TwoWayAnova result;
  result.a =
      tested_contrasts(within::product(a, within::constant(levels_b)), means, counts, squares, df);
  result.b =
      tested_contrasts(within::product(within::constant(levels_a), b), means, counts, squares, df);
  result.interaction = tested_contrasts(within::product(a, b), means, counts, squares, df);
  return result;
}

}  // namespace haptrial::analysis
