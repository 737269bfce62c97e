#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace haptrial::bone {

/// The levels that turn the numbers of a CT into bone.
struct GreyLevels {
  double threshold;  // from here on it is bone
  double dense;      // from here on its density is 1; above `threshold`
};

/// The density of bone with value v, a line from 0.2 at the threshold T to 1 at dense bone D, in
/// steps of 1/255, and 0 below T. With T = 300 HU and D = 1500 HU that is v/D.
float density_of(double value, const GreyLevels& levels);

/// How often values occur, in equal bins between the least and the greatest.
struct GreyHistogram {
  static constexpr std::size_t kBins = 512;

  explicit GreyHistogram(std::span<const float> values);
  double value_of(double bin) const { return low + width * bin; }

  std::array<double, kBins> counts{};
  double low{0.0};    // where the first bin begins
  double width{1.0};  // of a bin > 0
};

/// Findings of an import about the numbers of a grey volume.
struct GreyFindings {
  GreyHistogram histogram;
  double suggested;                // threshold, by find_threshold()
  std::optional<GreyLevels> used;  // nothing where the numbers say too little for any
};

/// The upper of the two thresholds that split the values into three classes, air, soft tissue and
/// bone, with the greatest variance between them; over 512 equal bins. Source: Otsu 1979.
double find_threshold(std::span<const float> values);
double find_threshold(const GreyHistogram& histogram);

/// The value that a share of those from `low` on stay below.
double quantile_from(std::span<const float> values, double low, double share);

}  // namespace haptrial::bone
