#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis::degenerate {

using Values = std::vector<double>;

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Samples that break formulas: nothing, one value, no variance, too large, too small, not numbers.
inline const std::vector<Values> kSamples{{},
                                          {3.0},
                                          {3.0, 3.0},
                                          {3.0, 3.0, 3.0, 3.0},
                                          {1.0, 2.0},
                                          {1.0, 2.0, 3.0},
                                          {0.1, 0.2, 0.3, 0.4},
                                          {1.0, 1.0, 2.0, 2.0},
                                          {0.1 + 0.2, 0.3, 0.3},
                                          {kNan, 1.0, 2.0},
                                          {kInfinity, 1.0, 2.0},
                                          {1e308, -1e308, 1e308},
                                          {1e200, -3e200, 2e200},
                                          {1e-200, 2e-200, 5e-200},
                                          {5e-324, 0.0, 1e-323},
                                          {1e12 + 0.125, 1e12, 1e12 + 0.5, 1e12},
                                          {-0.0, 0.0, 0.0},
                                          {1.0, 1.0, 1.0, 1e15}};

inline void expect_numbers(const std::string& what, const Values& values) {
  for (const double value : values) {
    EXPECT_TRUE(std::isfinite(value)) << what;
  }
}

inline void expect_p(const std::string& what, double p) {
  EXPECT_TRUE(p >= 0.0 && p <= 1.0) << what << ": p = " << p;
}

template <class T>
bool has_value(const std::string& what, const Defined<T>& result) {
  if (!result) {
    EXPECT_FALSE(result.because().empty()) << what;
  }
  return static_cast<bool>(result);
}

inline std::string name(std::size_t i, std::size_t j) {
  return "samples " + std::to_string(i) + " and " + std::to_string(j);
}

}  // namespace haptrial::analysis::degenerate
