#pragma once

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {

/// Scale r of the prior of the effect size, Cauchy(0, r): "medium" of Rouder et al. 2009.
inline constexpr double kMediumPrior = 0.70710678118654752;

/// The Bayes factor of a t-test for an effect against none (Rouder, Speckman, Sun, Morey and
/// Iverson 2009, Psychonomic Bulletin & Review 16):
///
///     BF = ∫ Cauchy(δ; r) f(t; df, δ sqrt(N)) dδ / f(t; df, 0)
///
/// with f the density of the noncentral t distribution and δ the effect size in standard
/// deviations; a directed test has the half of the prior on its side, doubled (Morey and Rouder
/// 2011). Relative error below 1e-6.
/// @param t  its sign is that of mean(a) - mean(b); finite
/// @param df  > 0
/// @param n  pairs; of two samples of different people n_a n_b / (n_a + n_b) > 0
/// Undefined where the integral is not finite.
Defined<double> bayes_factor(double t, double df, double n, Tail tail, double scale = kMediumPrior);

}  // namespace haptrial::analysis
