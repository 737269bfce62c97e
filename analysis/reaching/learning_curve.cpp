#include "analysis/reaching/learning_curve.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

using Row = std::vector<std::optional<double>>;

struct Sum {
  double value{0.0};
  double count{0.0};
};

bool is_complete(const CycleTable& table) {
  return std::ranges::all_of(table.values, [](const Row& row) {
    return std::ranges::all_of(row, [](const auto& value) { return value.has_value(); });
  });
}

std::vector<double> column_of(const CycleTable& table, std::size_t cycle) {
  std::vector<double> column;
  for (const Row& row : table.values) {
    if (row[cycle]) {
      column.push_back(*row[cycle]);
    }
  }
  return column;
}

double mean_of(const Row& row) {
  double sum = 0.0;
  for (const auto& value : row) {
    sum += *value;
  }
  return sum / static_cast<double>(row.size());
}

/// The table without the participants' levels: each row minus its mean.
CycleTable levelled(CycleTable table) {
  for (Row& row : table.values) {
    const double mean = mean_of(row);
    for (auto& value : row) {
      *value -= mean;
    }
  }
  return table;
}

void set_intervals(const CycleTable& table, double level, std::vector<CyclePoint>& curve) {
  const bool complete = is_complete(table);
  const CycleTable own = complete ? levelled(table) : CycleTable{};
  const auto cycles = static_cast<double>(table.cycles());
  for (std::size_t c = 0; c < curve.size(); ++c) {
    CyclePoint& point = curve[c];
    if (const auto all = mean_interval(column_of(table, c), level)) {
      point.between = CyclePoint::Limits{all->low, all->high};
    }
    if (!complete || table.cycles() < 2) {
      point.within =
          Undefined{complete ? "there is one cycle only" : "a participant has no value in a cycle"};
    } else if (const auto left = mean_interval(column_of(own, c), level)) {
      const double half = 0.5 * (left->high - left->low) * std::sqrt(cycles / (cycles - 1.0));
      point.within = CyclePoint::Limits{point.mean - half, point.mean + half};
    } else {
      point.within = Undefined{left.because()};
    }
  }
}

std::optional<double> mean_over(const Row& row, CycleRange range) {
  Sum sum;
  for (std::size_t c = range.first; c <= range.last; ++c) {
    if (row[c]) {
      sum.value += *row[c];
      sum.count += 1.0;
    }
  }
  return sum.count > 0.0 ? std::optional(sum.value / sum.count) : std::nullopt;
}

}  // namespace

CycleTable cycle_means(std::span<const TrialValue> trials, std::size_t n) {
  if (n == 0) {
    throw std::invalid_argument("n: a cycle has at least one trial");
  }
  std::map<std::size_t, std::map<std::size_t, Sum>> sums;
  std::size_t cycles = 0;
  for (const TrialValue& trial : trials) {
    Sum& sum = sums[trial.participant][trial.trial / n];
    cycles = std::max(cycles, trial.trial / n + 1);
    if (trial.value) {
      if (!std::isfinite(*trial.value)) {
        throw std::invalid_argument("value must be finite or nothing");
      }
      sum.value += *trial.value;
      sum.count += 1.0;
    }
  }
  CycleTable table;
  for (const auto& [participant, own] : sums) {
    Row row(cycles);
    for (const auto& [cycle, sum] : own) {
      if (sum.count > 0.0) {
        row[cycle] = sum.value / sum.count;
      }
    }
    table.participants.push_back(participant);
    table.values.push_back(std::move(row));
  }
  return table;
}

std::vector<CyclePoint> learning_curve(const CycleTable& table, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  std::vector<CyclePoint> curve(table.cycles());
  for (std::size_t c = 0; c < curve.size(); ++c) {
    const auto column = column_of(table, c);
    curve[c].participants = column.size();
    if (const auto all = moments(column)) {
      curve[c].mean = all->mean();
    }
  }
  set_intervals(table, level, curve);
  return curve;
}

Defined<CycleContrast> cycle_contrast(const CycleTable& table, CycleRange a,
                                      std::optional<CycleRange> b, Tail tail, double level) {
  for (const CycleRange& range : {a, b.value_or(a)}) {
    if (range.first > range.last || range.last >= table.cycles()) {
      throw std::invalid_argument("cycles of a contrast must lie inside the table");
    }
  }
  std::vector<double> left, right;
  CycleContrast contrast;
  for (const Row& row : table.values) {
    const auto one = mean_over(row, a);
    const auto two = b ? mean_over(row, *b) : 0.0;
    if (one && two) {
      left.push_back(*one);
      right.push_back(*two);
    } else {
      ++contrast.left_out;
    }
  }
  const auto test = paired_t_test(left, right, tail, level);
  if (!test) {
    return Undefined{test.because()};
  }
  contrast.test = *test;
  contrast.participants = left.size();
  return contrast;
}

}  // namespace haptrial::analysis
