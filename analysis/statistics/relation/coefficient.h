#pragma once

namespace haptrial::analysis {

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
