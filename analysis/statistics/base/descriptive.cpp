#include "analysis/statistics/base/descriptive.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

constexpr double kRounding = 1e-14;  // of a value that was computed, relative

// A sum that keeps what rounding drops (Neumaier 1974).
class Sum {
 public:
  void add(double x) {
    const double next = sum_ + x;
    dropped_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
  }
  double value() const { return sum_ + dropped_; }

 private:
  double sum_{0.0};
  double dropped_{0.0};
};

}  // namespace

double mean_difference(const Moments& a, const Moments& b) {
  return (a.origin - b.origin) + (a.offset - b.offset);
}

Defined<Moments> moments(std::span<const double> values) {
  if (values.empty()) {
    return Undefined{"there are no values"};
  }
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    return Undefined{"a value is not a finite number"};
  }
  const auto n = static_cast<double>(values.size());
  Moments result{values.size(), values.front()};
  Sum sum;
  for (const double v : values) {
    sum.add(v - result.origin);
  }
  result.offset = sum.value() / n;

  Sum residual;  // what the rounded mean leaves of the deviations; corrects both sums
  Sum squares;
  for (const double v : values) {
    const double deviation = (v - result.origin) - result.offset;
    residual.add(deviation);
    squares.add(deviation * deviation);
  }
  const double rest = residual.value();
  result.squares = std::max(0.0, squares.value() - rest * rest / n);
  result.offset += rest / n;
  if (!std::isfinite(result.squares) || !std::isfinite(result.mean())) {
    return Undefined{kBeyondDouble};
  }
  return result;
}

Defined<MeanInterval> mean_interval(std::span<const double> values, double level) {
  const auto m = moments(values);
  if (!m) {
    return Undefined{m.because()};
  }
  if (m->count < 2) {
    return Undefined{"an interval needs at least two values"};
  }
  const double deviation = std::sqrt(m->variance());
  const auto [least, most] = std::ranges::minmax(values);
  if (!(deviation > kRounding * std::max(std::abs(least), std::abs(most)))) {
    return Undefined{"the values do not vary"};
  }
  const auto n = static_cast<double>(m->count);
  const double half = t_quantile(0.5 * (1.0 + level), n - 1.0) * deviation / std::sqrt(n);
  return MeanInterval{m->count, m->mean(), deviation, m->mean() - half, m->mean() + half};
}

Mean mean_and_interval(std::span<const double> values) {
  Mean mean{Undefined{"there are no values"}, mean_interval(values)};
  if (const auto m = moments(values)) {
    mean.value = m->mean();
  }
  return mean;
}

Defined<double> quantile(std::span<const double> values, double fraction) {
  if (const auto m = moments(values); !m) {
    return Undefined{m.because()};
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

bool Ranks::all_tied() const {
  const auto n = static_cast<double>(ranks.size());
  return ties == n * n * n - n;
}

Defined<Ranks> midranks(std::span<const double> values) {
  if (values.empty()) {
    return Undefined{"there are no values"};
  }
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    return Undefined{"a value is not a finite number"};
  }
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  Ranks result{std::vector<double>(values.size())};
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) {
      ++end;
    }
    for (std::size_t i = first; i < end; ++i) {
      result.ranks[order[i]] = 0.5 * static_cast<double>(first + 1 + end);
    }
    const auto tied = static_cast<double>(end - first);
    result.ties += tied * tied * tied - tied;
    first = end;
  }
  return result;
}

}  // namespace haptrial::analysis
