#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace haptrial {

/// The length of the longest of some vectors, in their unit; 0 without any. Any thread.
inline double longest_of(const std::vector<Eigen::Vector3d>& vectors) {
  double longest = 0.0;
  for (const Eigen::Vector3d& vector : vectors) {
    longest = std::max(longest, vector.norm());
  }
  return longest;
}

}  // namespace haptrial
