#pragma once

#include <span>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

struct ShapiroWilk {
  double w{0.0};  // 0 .. 1; 1 for data that look like a normal sample
  double p{0.0};  // small where they do not
};

/// Shapiro and Wilk's test that a sample is from a normal distribution, by Royston's
/// approximations: algorithm AS R94.
/// Undefined with fewer than 3 or more than 5000 values (the approximations end there), values that
/// are all equal, or one that is not finite.
/// Source: Royston 1995, Applied Statistics 44.
Defined<ShapiroWilk> shapiro_wilk(std::span<const double> values);

}  // namespace haptrial::analysis
