#pragma once

#include <cstddef>
#include <vector>

#include "core/base/random.h"

namespace haptrial::test {

/// Normal with a standard deviation of 1.
inline std::vector<double> normal_values(RandomStream& random, std::size_t count,
                                         double mean = 0.0) {
  std::vector<double> values(count);
  for (double& value : values) {
    value = mean + random.normal();
  }
  return values;
}

}  // namespace haptrial::test
