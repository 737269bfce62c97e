#pragma once

#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Ranks of values, in the order given. Values tie where they are equal to the last bit.
struct Ranks {
  std::vector<double> ranks;  // from 1; tied values share the mean of their ranks
  double ties{0.0};           // sum of t³ - t over sets of t tied values; 0 without ties

  bool all_tied() const;
};

/// Undefined without values or with one that is not finite.
Defined<Ranks> midranks(std::span<const double> values);

}  // namespace haptrial::analysis
