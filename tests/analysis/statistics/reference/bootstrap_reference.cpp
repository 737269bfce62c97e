#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/tests/bootstrap.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::bootstrap_reference {
namespace {

using Values = std::vector<double>;
using Statistic = double (*)(const Values& drawn, const Values& second);

// The rows that the script draws: x <- 16807 x mod (2^31 - 1).
std::vector<std::vector<std::size_t>> draws(std::size_t n, std::size_t count) {
  std::uint64_t x = 20061;
  std::vector<std::vector<std::size_t>> rows(count, std::vector<std::size_t>(n));
  for (auto& row : rows) {
    for (auto& place : row) {
      x = 16807 * x % 2147483647;
      place = x % n;
    }
  }
  return rows;
}

Values picked(const Values& values, const std::vector<std::size_t>& rows) {
  Values result;
  for (const auto row : rows) {
    result.push_back(values[row]);
  }
  return result;
}

std::vector<std::size_t> all_but(std::size_t n, std::size_t left_out) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < n; ++i) {
    if (i != left_out) {
      rows.push_back(i);
    }
  }
  return rows;
}

double mean(const Values& values) { return moments(values)->mean(); }

void compare_interval(Answers::Case at, const Defined<BootstrapInterval>& interval) {
  at.is("estimate", interval->estimate)
      .is("low", interval->low)
      .is("high", interval->high)
      .is("bias", interval->bias)
      .is("acceleration", interval->acceleration);
}

void compare_one(Answers& r, const std::string& name, Statistic statistic) {
  const DataSet pairs("pairs");
  const Values first = pairs.numbers("first");
  const Values second = pairs.numbers("second");
  Values replicates, left_out;
  for (const auto& rows : draws(first.size(), 1999)) {
    replicates.push_back(statistic(picked(first, rows), picked(second, rows)));
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto rows = all_but(first.size(), i);
    left_out.push_back(statistic(picked(first, rows), picked(second, rows)));
  }
  for (const double level : {0.9, 0.95}) {
    compare_interval(r.at("BCa bootstrap of one sample", fmt::format("{} {:g}", name, level)),
                     bca_interval(statistic(first, second), replicates, {left_out}, level));
  }
}

Values logarithms(Values values) {
  for (auto& value : values) {
    value = std::log(value);
  }
  return values;
}

void compare_two(Answers& r) {
  const auto groups = DataSet("unequal").groups("value", "group");
  const Values b = logarithms(groups[1]);
  const Values d = logarithms(groups[3]);
  const auto rows_b = draws(b.size(), 1999);
  const auto rows_d = draws(d.size(), 1999);
  Values replicates;
  for (std::size_t i = 0; i < rows_b.size(); ++i) {
    replicates.push_back(mean(picked(b, rows_b[i])) - mean(picked(d, rows_d[i])));
  }
  std::vector<Values> left_out(2);
  for (std::size_t i = 0; i < b.size(); ++i) {
    left_out[0].push_back(mean(picked(b, all_but(b.size(), i))) - mean(d));
  }
  for (std::size_t i = 0; i < d.size(); ++i) {
    left_out[1].push_back(mean(b) - mean(picked(d, all_but(d.size(), i))));
  }
  compare_interval(r.at("BCa bootstrap of a difference", "b and d 0.95"),
                   bca_interval(mean(b) - mean(d), replicates, left_out, 0.95));
}

void compare(Answers& r) {
  compare_one(r, "mean", [](const Values& drawn, const Values&) { return mean(drawn); });
  compare_one(r, "spread", [](const Values& drawn, const Values&) {
    return std::log(moments(drawn)->variance());
  });
  compare_one(r, "ratio",
              [](const Values& drawn, const Values& second) { return mean(drawn) / mean(second); });
  compare_two(r);
}

const Topic kTopic("bootstrap", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::bootstrap_reference
