#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace haptrial::bone {

/// What turns numbers of a CT into bone.
struct GreyLevels {
  double threshold;  // from here on it is bone
  double dense;      // from here on its density is 1; above `threshold`
};

/// The density of bone with value v, a line from 0.2 at the threshold T to 1 at dense bone D, in
/// steps of 1/255, and 0 below T. With T = 300 HU and D = 1500 HU that is v/D.
float density_of(double value, const GreyLevels& levels);

/// The upper of the two thresholds that split the values into three classes, air, soft tissue and
/// bone, with the greatest variance between them; over 512 equal bins. Source: Otsu 1979.
double find_threshold(std::span<const float> values);

/// The value that a share of those from `low` on stay below.
double quantile_from(std::span<const float> values, double low, double share);

}  // namespace haptrial::bone
