#include "analysis/statistics/variance/rank_anova.h"

#include <algorithm>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/ranks.h"
#include "analysis/statistics/variance/within_effect.h"

namespace haptrial::analysis {
namespace {

using Table = std::vector<std::vector<double>>;

RankAnova tested(double chi_squared, double df) {
  return {chi_squared, df, chi_squared_upper_tail(chi_squared, df)};
}

}  // namespace

Defined<RankAnova> kruskal_wallis(const Table& groups) {
  if (groups.size() < 2) {
    return Undefined{"there are fewer than two groups"};
  }
  std::vector<double> all;
  for (const auto& group : groups) {
    if (group.empty()) {
      return Undefined{"a group is empty"};
    }
    all.insert(all.end(), group.begin(), group.end());
  }
  const auto ranks = midranks(all);
  if (!ranks) {
    return Undefined{ranks.because()};
  }
  if (all.size() == groups.size()) {
    return Undefined{"every group has a single value"};
  }
  if (ranks->all_tied()) {
    return Undefined{"all values are equal"};
  }
  const auto total = static_cast<double>(all.size());
  double squares = 0.0;  // of the groups' mean ranks
  auto rank = ranks->ranks.begin();
  for (const auto& group : groups) {
    const auto count = static_cast<double>(group.size());
    double excess = 0.0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      excess += *rank++ - 0.5 * (total + 1.0);
    }
    squares += excess * excess / count;
  }
  const double untied = 1.0 - ranks->ties / (total * (total * total - 1.0));
  return tested(12.0 * squares / (total * (total + 1.0)) / untied,
                static_cast<double>(groups.size() - 1));
}

Defined<RankAnova> friedman(const Table& table) {
  if (auto problem = within::problem(table); !problem.empty()) {
    return Undefined{std::move(problem)};
  }
  const std::size_t conditions = table.front().size();
  const auto n = static_cast<double>(table.size());
  const auto k = static_cast<double>(conditions);
  std::vector<double> excess(conditions, 0.0);  // of the conditions' rank sums
  double ties = 0.0;
  for (const auto& row : table) {
    const Ranks ranks = *midranks(row);
    ties += ranks.ties;
    for (std::size_t j = 0; j < conditions; ++j) {
      excess[j] += ranks.ranks[j] - 0.5 * (k + 1.0);
    }
  }
  const double spread = n * k * (k + 1.0) - ties / (k - 1.0);
  if (spread <= 0.0) {
    return Undefined{"every participant's values are all equal"};
  }
  double squares = 0.0;
  for (const double e : excess) {
    squares += e * e;
  }
  return tested(12.0 * squares / spread, k - 1.0);
}

}  // namespace haptrial::analysis
