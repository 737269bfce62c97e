#pragma once

#include <span>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// A point whose two coordinates are means of repeated values.
struct NoisyPoint {
  double x{0.0}, y{0.0};
  double count{1.0};  // of the repeated values, >= 1
};

/// How repeated values scatter around their own means.
struct RepeatScatter {
  double xx{0.0};  // variance, > 0
  double yy{0.0};  // likewise
  double xy{0.0};  // covariance
};

/// A line through points that are uncertain in both directions.
struct NoisyLine {
  double slope{0.0}, intercept{0.0};
  double error{0.0};  // standard error of the slope; infinite for two points
  double df{0.0};     // points less 2
};

/// The line y = a + b x that minimises
///
///     sum_i n_i (y_i - a - b x_i)² / (s_yy - 2 b s_xy + b² s_xx)
///
/// the most likely one if points lie on a line and their means scatter as s / n_i does. A slope
/// from y on x alone comes out too small if x has errors. Without a covariance this is Deming's
/// line. The standard error scales York's with the scatter of the points around the line.
/// Undefined with fewer than two points, if a variance is not above 0, or if x does not vary more
/// than its errors explain.
/// Source: Deming 1943; York, Evensen, Martínez and Delgado 2004, equations 13a to 14; Fuller 1987,
/// Measurement Error Models, chapter 1.3.
Defined<NoisyLine> noisy_line(std::span<const NoisyPoint> points, const RepeatScatter& scatter);

}  // namespace haptrial::analysis
