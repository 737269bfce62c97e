#pragma once

#include <limits>
#include <vector>

namespace haptrial::analysis {

/// An estimate with its 95 % interval; NaN: not known.
struct Interval {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double value{kNone};
  double low{kNone}, high{kNone};
  double df{0.0};  // degrees of freedom behind the interval
};

/// value ± t(df) · error.
Interval interval_of(double value, double error, double df);

/// Mean of independent estimates; its interval combines theirs (Welch and Satterthwaite).
/// @param parts  at least one
Interval mean_of(const std::vector<Interval>& parts);

}  // namespace haptrial::analysis
