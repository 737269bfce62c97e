#pragma once

#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// The alternative to equal means.
enum class Tail {
  kTwoSided,
  kLess,     // mean(a) < mean(b)
  kGreater,  // mean(a) > mean(b)
};

struct TTest {
  double t{0.0};           // the sign of mean(a) - mean(b)
  double df{0.0};          // not an integer for Welch's test
  double p{0.0};           // for the tail asked for
  double difference{0.0};  // mean(a) - mean(b)
  double low{0.0};         // two-sided interval of the difference, whatever the tail
  double high{0.0};
  double error{0.0};  // standard error of the difference
};

/// The test of a difference whose standard error and degrees of freedom are known.
/// Undefined where t or the difference is not finite, or without degrees of freedom.
Defined<TTest> t_test_of(double difference, double error, double df, Tail tail, double level);

/// @param level  coverage of the interval of the difference, inside (0, 1); the same for each test.

/// Student's test with pooled variance.
/// Undefined with an empty sample, fewer than three values, no variance, or a value not finite.
Defined<TTest> student_t_test(std::span<const double> a, std::span<const double> b, Tail tail,
                              double level = 0.95);

/// Welch's test; variances may differ. Undefined with fewer than two values in either sample, no
/// variance in both, or a value that is not finite.
Defined<TTest> welch_t_test(std::span<const double> a, std::span<const double> b, Tail tail,
                            double level = 0.95);

/// Student's test of the differences a[i] - b[i]. Undefined with fewer than two pairs, equal
/// differences, or a value that is not finite.
/// @throws std::invalid_argument when the lengths differ.
Defined<TTest> paired_t_test(std::span<const double> a, std::span<const double> b, Tail tail,
                             double level = 0.95);

/// Strata of participants weighed alike, however many each has:
///
///     mean over s of mean(a[s]) - mean over s of mean(b[s])
///
/// with the variance of each stratum its own and Welch and Satterthwaite's degrees of freedom.
/// @param b  as many strata as `a`; none: `a` holds differences of pairs.
/// Undefined with a stratum of fewer than two values, no variance in any, or a value that is not
/// finite.
Defined<TTest> stratified_t_test(const std::vector<std::vector<double>>& a,
                                 const std::vector<std::vector<double>>& b, Tail tail,
                                 double level = 0.95);

/// Two one-sided tests against a difference of -bound and of bound (Schuirmann 1987).
struct EquivalenceTest {
  double bound{0.0};
  double p{1.0};               // that the difference lies outside of the bounds
  double low{0.0}, high{0.0};  // 90 % interval of the difference; within the bounds if p < 0.05
};

/// @param test  of the same difference.  @param bound  > 0
EquivalenceTest equivalence_test(const TTest& test, double bound);

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
