#pragma once

#include <cstddef>
#include <span>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

struct Correlation {
  struct Interval {
    double low{0.0};
    double high{0.0};
  };

  double r{0.0};
  double p{0.0};  // two-sided
  std::size_t count{0};
  Defined<Interval> interval{Undefined{"nothing was correlated"}};  // needs four pairs
};

/// Pearson's r; p from Student's t, interval from Fisher's z.
/// Undefined with fewer than three pairs, a variable that does not vary, or a value that is not
/// finite. @throws std::invalid_argument when the lengths differ.
Defined<Correlation> pearson_correlation(std::span<const double> a, std::span<const double> b,
                                         double level = 0.95);

/// Spearman's rho: Pearson's r of the ranks. p of up to nine pairs counts every arrangement, also
/// with ties; of more it is Algorithm AS 89 (Best and Roberts 1975, Applied Statistics 24), or
/// Student's t where there are ties. Interval: Fisher's z with the variance
/// (1 + rho² / 2) / (n - 3), Bonett and Wright 2000, Psychometrika 65. Undefined and throws as
/// pearson_correlation.
Defined<Correlation> spearman_correlation(std::span<const double> a, std::span<const double> b,
                                          double level = 0.95);

/// An estimated coefficient held against 0.
struct Coefficient {
  double estimate{0.0};
  double error{0.0};  // standard error
  double df{0.0};
  double t{0.0};
  double p{0.0};    // two-sided
  double low{0.0};  // interval from Student's t
  double high{0.0};
};

/// @param error  > 0; df > 0; level inside (0, 1).
Coefficient coefficient(double estimate, double error, double df, double level);

}  // namespace haptrial::analysis
