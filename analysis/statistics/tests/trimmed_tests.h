#pragma once

#include <span>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {

/// Yuen's test of trimmed means (Yuen 1974, Biometrika 61), which a few extreme values hardly
/// move. Differences and intervals are those of trimmed means.
/// @param share  of the values that each tail is trimmed by, in [0, 0.5)

/// Different people, with Welch's degrees of freedom.
/// Undefined with fewer than two values left in either sample, no variance in both, or a value that
/// is not finite.
Defined<TTest> yuen_test(std::span<const double> a, std::span<const double> b, double share,
                         Tail tail, double level = 0.95);

/// Pairs: each sample is trimmed by itself (Wilcox 2012, Introduction to Robust Estimation).
/// Undefined with fewer than two pairs left, no variance, or a value that is not finite.
/// @throws std::invalid_argument when the lengths differ.
Defined<TTest> paired_yuen_test(std::span<const double> a, std::span<const double> b, double share,
                                Tail tail, double level = 0.95);

}  // namespace haptrial::analysis
