#include "analysis/anova.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "analysis/descriptive.h"
#include "analysis/distributions.h"

namespace haptrial::analysis {
namespace {

using Table = std::vector<std::vector<double>>;

// Moments of all values from those of the groups: deviations of group means from the grand mean.
double between_squares(const std::vector<Moments>& groups) {
  double total = 0.0;
  double offset = 0.0;  // grand mean - mean of the first group
  for (const auto& group : groups) {
    total += static_cast<double>(group.count);
    offset += static_cast<double>(group.count) * mean_difference(group, groups.front());
  }
  offset /= total;
  double squares = 0.0;
  for (const auto& group : groups) {
    const double deviation = mean_difference(group, groups.front()) - offset;
    squares += static_cast<double>(group.count) * deviation * deviation;
  }
  return squares;
}

Defined<std::vector<Moments>> group_moments(const Table& groups) {
  std::vector<Moments> result;
  for (const auto& group : groups) {
    const auto m = moments(group);
    if (!m) {
      return Undefined{group.empty() ? "a group is empty" : m.because()};
    }
    result.push_back(*m);
  }
  return result;
}

// The table without its first value, so that rounding is relative to the differences.
Table shifted(const Table& table) {
  Table result = table;
  for (auto& row : result) {
    for (auto& value : row) {
      value -= table.front().front();
    }
  }
  return result;
}

struct Margins {
  std::vector<double> rows;     // (participants)
  std::vector<double> columns;  // (conditions)
  double grand{0.0};
};

Margins margins(const Table& table) {
  Margins m{std::vector<double>(table.size()), std::vector<double>(table.front().size())};
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    for (std::size_t j = 0; j < m.columns.size(); ++j) {
      m.rows[i] += table[i][j] / static_cast<double>(m.columns.size());
      m.columns[j] += table[i][j] / static_cast<double>(m.rows.size());
    }
    m.grand += m.rows[i] / static_cast<double>(m.rows.size());
  }
  return m;
}

// What is left of each value without its participant's and its condition's mean.
Table residuals(const Table& table, const Margins& m) {
  Table result = table;
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    for (std::size_t j = 0; j < m.columns.size(); ++j) {
      result[i][j] -= m.rows[i] + m.columns[j] - m.grand;
    }
  }
  return result;
}

double sum_of_squares(const Table& table) {
  double sum = 0.0;
  for (const auto& row : table) {
    for (const double v : row) {
      sum += v * v;
    }
  }
  return sum;
}

// The residuals' covariance is the double-centred covariance C of the conditions:
// epsilon = trace(C)^2 / ((k - 1) trace(C C)).
double greenhouse_geisser(const Table& residual) {
  const std::size_t k = residual.front().size();
  double trace = 0.0;
  double trace_of_square = 0.0;
  for (std::size_t a = 0; a < k; ++a) {
    for (std::size_t b = 0; b < k; ++b) {
      double covariance = 0.0;
      for (const auto& row : residual) {
        covariance += row[a] * row[b];
      }
      trace += a == b ? covariance : 0.0;
      trace_of_square += covariance * covariance;
    }
  }
  const auto spans = static_cast<double>(k - 1);
  return std::clamp(trace * trace / (spans * trace_of_square), 1.0 / spans, 1.0);
}

// Empty when the table can be analysed.
std::string table_problem(const Table& table) {
  if (table.size() < 2) {
    return "fewer than two participants have a mean in every condition";
  }
  if (table.front().size() < 2) {
    return "there are fewer than two conditions";
  }
  for (const auto& row : table) {
    if (row.size() != table.front().size()) {
      return "a participant lacks a condition";
    }
    if (!std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); })) {
      return "a value is not a finite number";
    }
  }
  return {};
}

// Residuals that only rounding made.
bool is_rounding(double squares, const Table& table) {
  double largest = 0.0;
  for (const auto& row : table) {
    for (const double v : row) {
      largest = std::max(largest, std::abs(v));
    }
  }
  const auto count = static_cast<double>(table.size() * table.front().size());
  const double unit = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  return squares <= count * unit * unit;
}

}  // namespace

Defined<Anova> one_way_anova(const Table& groups) {
  if (groups.size() < 2) {
    return Undefined{"there are fewer than two groups"};
  }
  const auto each = group_moments(groups);
  if (!each) {
    return Undefined{each.because()};
  }
  Anova result;
  double total = 0.0;
  for (const auto& group : *each) {
    total += static_cast<double>(group.count);
    result.squares_within += group.squares;
  }
  result.df_between = static_cast<double>(groups.size() - 1);
  result.df_within = total - static_cast<double>(groups.size());
  if (result.df_within < 1.0) {
    return Undefined{"every group has a single value"};
  }
  if (result.squares_within == 0.0) {
    return Undefined{"the values do not vary within any group"};
  }
  result.squares_between = between_squares(*each);
  result.f =
      (result.squares_between / result.df_between) / (result.squares_within / result.df_within);
  result.p = f_upper_tail(result.f, result.df_between, result.df_within);
  result.eta_squared = result.squares_between / (result.squares_between + result.squares_within);
  return result;
}

Defined<RepeatedAnova> repeated_measures_anova(const Table& original) {
  if (auto problem = table_problem(original); !problem.empty()) {
    return Undefined{std::move(problem)};
  }
  const Table table = shifted(original);
  const Margins m = margins(table);
  const Table residual = residuals(table, m);

  RepeatedAnova result{m.rows.size(), m.columns.size()};
  const auto n = static_cast<double>(m.rows.size());
  const auto k = static_cast<double>(m.columns.size());
  for (const double row : m.rows) {
    result.squares_participants += k * (row - m.grand) * (row - m.grand);
  }
  for (const double column : m.columns) {
    result.squares_condition += n * (column - m.grand) * (column - m.grand);
  }
  result.squares_error = sum_of_squares(residual);
  // Against the original values: their last digits bound what a difference can mean.
  if (is_rounding(result.squares_error, original)) {
    return Undefined{"the conditions differ by the same amount for every participant"};
  }
  result.df_condition = k - 1.0;
  result.df_error = (k - 1.0) * (n - 1.0);
  result.f =
      (result.squares_condition / result.df_condition) / (result.squares_error / result.df_error);
  result.p = f_upper_tail(result.f, result.df_condition, result.df_error);
  result.epsilon = greenhouse_geisser(residual);
  result.p_corrected = f_upper_tail(result.f, result.epsilon * result.df_condition,
                                    result.epsilon * result.df_error);
  result.partial_eta_squared =
      result.squares_condition / (result.squares_condition + result.squares_error);
  return result;
}

}  // namespace haptrial::analysis
