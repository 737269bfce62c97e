#pragma once

#include <cstddef>
#include <span>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {

/// A test on ranks. With fewer than 50 values (in either sample) p is exact: the share of all
/// signs, or of all choices of the first sample, whose statistic is as far from its expectation,
/// given the ranks as they are, ties included. With more it is from the normal approximation, its
/// variance corrected for ties, with half a unit of correction for continuity.
struct RankTest {
  double statistic{0.0};
  double p{0.0};  // for the tail asked for
  bool exact{false};
  std::size_t count{0};  // values, or pairs that differ
};

/// Wilcoxon's test that the differences a[i] - b[i] are symmetric about 0. `statistic` is V, the
/// sum of the ranks of the positive ones; equal pairs are left out.
/// Undefined without pairs, with pairs that are all equal, or a value that is not finite.
/// @throws std::invalid_argument when the lengths differ.
/// Source: Wilcoxon 1945, Biometrics Bulletin 1.
Defined<RankTest> wilcoxon_signed_rank(std::span<const double> a, std::span<const double> b,
                                       Tail tail);

/// Mann and Whitney's test that neither sample tends to larger values. `statistic` is U of the
/// first sample (R's W): the pairs with a[i] > b[j], ties counting half.
/// Undefined with an empty sample, values that are all equal, or a value that is not finite.
/// Source: Mann and Whitney 1947, Annals of Mathematical Statistics 18.
Defined<RankTest> mann_whitney(std::span<const double> a, std::span<const double> b, Tail tail);

}  // namespace haptrial::analysis
