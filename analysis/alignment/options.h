#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::analysis {

/// Which steps a path may take, as advances (along the target, along the applied curve), and the
/// weight of the error of each pair that a step reaches. Every step but (1,1) also pays the
/// penalty; with a penalty of 0 all but the first are the patterns that the literature knows by
/// these names (docs/algorithms/alignment-options.md). Source: Sakoe and Chiba 1978.
enum class StepPattern {
  kPublished,    // (1,1), (1,0), (0,1), each of weight 1. Morris 2006, §4.3
  kSymmetric1,   // the same steps
  kSymmetric2,   // (1,1) of weight 2; (1,0) and (0,1) of weight 1
  kAsymmetric,   // (1,0), (1,1), (1,2), each of weight 1: a target sample is paired once
  kSymmetricP1,  // (1,1) of weight 2; (2,1) and (1,2): (1,1) of weight 2, then aside of weight 1
};

/// "published", "symmetric1", "symmetric2", "asymmetric", "symmetricP1".
std::string_view name_of(StepPattern pattern);
std::optional<StepPattern> pattern_of(std::string_view name);
const std::vector<std::string>& pattern_names();

/// The error of pairing point i of the target F with point j of the applied curve G, and which
/// paths are searched for the least cost:
///
///     e(i,j) = w_f |F_i - G_j|^p + w_s |F'_i - G'_j|^p
///
/// The defaults are the published form. Source: Morris 2006, §4.3, which leaves p open.
struct AlignmentOptions {
  double force_weight{1.0};  // w_f >= 0 [1/N^p]
  double slope_weight{0.5};  // w_s >= 0 [(s/N)^p]
  double penalty{0.5};       // >= 0, for each step but (1,1) [1]
  double power{1.0};         // p, 1 to 100
  StepPattern pattern{StepPattern::kPublished};

  /// Sakoe and Chiba's band, with both curves counted from their first sample to their last: a pair
  /// is no more than so many samples of the longer curve apart, or as many as the straight line
  /// from corner to corner needs. Absent: no band.
  std::optional<std::size_t> window{};  // >= 0 [samples]

  bool open_begin{false};  // a path may leave out applied samples at the start
  bool open_end{false};    // likewise at the end
};

/// The largest weight and penalty, and the largest error of a pair: keeps every sum far inside
/// single precision.
inline constexpr double kLargestAlignmentError = 1e12;

/// A sentence about options that are out of bounds or make no sense together; else empty.
std::string problem_of(const AlignmentOptions& options);

/// Whether the vector kernels serve these options; the rest is searched row by row.
bool is_vectorized(const AlignmentOptions& options);

/// Whether (1,1) has weight 2.
bool doubles_straight(StepPattern pattern);

}  // namespace haptrial::analysis
