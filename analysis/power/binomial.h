#pragma once

#include <cstddef>

namespace haptrial::analysis {

/// A share and its interval.
struct Share {
  double value{0.0};
  double low{0.0}, high{1.0};
};

/// found / of with the exact interval of Clopper and Pearson (1934). @param of  above 0
/// @param level  coverage, inside (0, 1)
Share share_of(std::size_t found, std::size_t of, double level = 0.95);

/// Counts that chance leaves with this probability, both inclusive.
struct CountBand {
  std::size_t low{0}, high{0};
  bool holds(std::size_t count) const { return count >= low && count <= high; }
};

/// Counts to expect of `of` independent events with the chance p each; at most (1 - level) / 2 of
/// the probability lies on either side.
CountBand binomial_band(std::size_t of, double p, double level);

}  // namespace haptrial::analysis
