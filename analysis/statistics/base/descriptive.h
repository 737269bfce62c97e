#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Mean and squared deviations of a sample, kept relative to its first value: data with many
/// constant leading digits lose none of the others, and equal values have exactly no deviation.
struct Moments {
  std::size_t count{0};
  double origin{0.0};   // the first value
  double offset{0.0};   // mean - origin
  double squares{0.0};  // sum of squared deviations from the mean

  /// 0 where both parts cancel but for rounding.
  double mean() const {
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    const double sum = origin + offset;
    return std::abs(sum) <= kRounding * std::abs(origin) ? 0.0 : sum;
  }
  /// count > 1.
  double variance() const { return squares / static_cast<double>(count - 1); }
};

/// mean(a) - mean(b), with the origins subtracted first.
double mean_difference(const Moments& a, const Moments& b);

/// Two passes. Undefined without values or with one that is not finite.
Defined<Moments> moments(std::span<const double> values);

/// A mean with its two-sided interval from Student's t.
struct MeanInterval {
  std::size_t count{0};
  double mean{0.0};
  double deviation{0.0};  // standard deviation, n - 1
  double low{0.0};
  double high{0.0};
};

/// @param level  coverage of the interval, inside (0, 1).
/// Undefined with fewer than two values, with one that is not finite, and if all are the same:
/// Student's t gives those no width, though the next one may be another.
Defined<MeanInterval> mean_interval(std::span<const double> values, double level = 0.95);

/// A mean of any number of values, with its interval where there is one.
struct Mean {
  Defined<double> value{Undefined{"there are no values"}};
  Defined<MeanInterval> interval{Undefined{"there are no values"}};
};
Mean mean_and_interval(std::span<const double> values);

/// The value below which a fraction of the values lies, linear between order statistics.
/// Undefined without values or with one that is not finite.
Defined<double> quantile(std::span<const double> values, double fraction);

/// Ranks of values, in the order given. Values tie where they are equal to the last bit.
struct Ranks {
  std::vector<double> ranks;  // from 1; tied values share the mean of their ranks
  double ties{0.0};           // sum of t³ - t over sets of t tied values; 0 without ties

  bool all_tied() const;
};

/// Undefined without values or with one that is not finite.
Defined<Ranks> midranks(std::span<const double> values);

}  // namespace haptrial::analysis
