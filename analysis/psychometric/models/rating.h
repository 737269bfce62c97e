#pragma once

#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/relation/roc.h"

namespace haptrial::analysis {

/// How often each rating was given, from "surely noise" to "surely signal"; both of one length, at
/// least two.
struct RatingCounts {
  std::vector<int> noise;
  std::vector<int> signal;
};

/// The curve through the observed points, its area by trapezoids with DeLong's interval.
/// Undefined without signal or noise trials.
/// @throws std::invalid_argument for lengths that differ or are below two, and negative counts.
Defined<Roc> rating_roc(const RatingCounts& counts, double level = 0.95);

/// Normal distributions of noise N(0, 1) and signal N(mean, sd^2) with a criterion between every
/// two ratings, by maximum likelihood (Dorfman and Alf 1969):
///
///     z(H) = a + b z(F),   a = mean / sd,   b = 1 / sd,   A_z = Phi(a / sqrt(1 + b^2))
struct BinormalRoc {
  double a{0.0};
  double b{1.0};
  double d_a{0.0};   // sqrt 2 a / sqrt(1 + b^2): d' where the variances are equal
  double area{0.0};  // A_z
  double area_low{0.0}, area_high{0.0};  // interval by the normal quantile of A_z
  std::vector<double> criteria;          // (ratings - 1) rising
  double log_likelihood{0.0};            // without multinomial coefficients
  double deviance{0.0};                  // against the observed shares
  int df{0};                             // of the deviance: ratings - 3
};

/// Ratings that nobody gave are dropped. Undefined unless at least three ratings remain and the
/// likelihood has a maximum. @throws std::invalid_argument as rating_roc.
Defined<BinormalRoc> binormal_roc(const RatingCounts& counts, double level = 0.95);

}  // namespace haptrial::analysis
