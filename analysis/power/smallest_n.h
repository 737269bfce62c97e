#pragma once

#include <optional>
#include <vector>

#include "analysis/power/power_result.h"

namespace haptrial::analysis {

/// The power of a number of participants.
struct PowerPoint {
  double n{0.0};
  TestCount count;
};

/// A number of participants at which the target is met, and the numbers at which the ends of the
/// power's 95 % band meet it.
struct SmallestN {
  std::optional<double> n;     // nothing: not up to the largest number
  std::optional<double> low;   // where the band's upper end meets it; nothing: likewise
  std::optional<double> high;  // where its lower end does
};

/// Smallest number by straight lines between the points, made to rise first (pool adjacent
/// violators, weighted by replications). A target that the smallest number meets is met at that
/// number.
/// @param points  by rising n, each with at least one test made
SmallestN smallest_n(const std::vector<PowerPoint>& points, double target);

}  // namespace haptrial::analysis
