#pragma once

#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/variance/anova.h"

namespace haptrial::analysis {

/// A standardised effect with its interval.
struct EffectSize {
  double value{0.0};
  double low{0.0};
  double high{0.0};
  double level{0.0};  // coverage of the interval
};

/// Standardised differences keep the 95 % of the t-test. Proportions of variance take 90 %: their
/// interval then leaves out 0 exactly when p < 0.05 (Steiger 2004, Psychological Methods 9).
inline constexpr double kDifferenceLevel = 0.95;
inline constexpr double kProportionLevel = 0.90;

/// Cohen's d: the difference of the means by the pooled standard deviation. The interval inverts
/// the noncentral t. Undefined as student_t_test.
Defined<EffectSize> cohens_d(std::span<const double> a, std::span<const double> b,
                             double level = kDifferenceLevel);

/// d_z: the mean difference by the standard deviation of the differences. Undefined and throws as
/// paired_t_test.
Defined<EffectSize> cohens_dz(std::span<const double> a, std::span<const double> b,
                              double level = kDifferenceLevel);

/// The difference of stratified_t_test by the standard deviation within strata, pooled over them.
/// @param b  as many strata as `a`; none: `a` holds differences of pairs.
/// Undefined where no value varies within its stratum, or one is not finite.
Defined<EffectSize> stratified_d(const std::vector<std::vector<double>>& a,
                                 const std::vector<std::vector<double>>& b,
                                 double level = kDifferenceLevel);

/// Hedges' g: d without its bias. The limits are those of d, as both estimate the same population
/// value. Undefined as student_t_test, and with one degree of freedom.
Defined<EffectSize> hedges_g(std::span<const double> a, std::span<const double> b,
                             double level = kDifferenceLevel);

/// Factor for d, Gamma(df / 2) / (sqrt(df / 2) Gamma((df - 1) / 2)); df > 1. Source: Hedges 1981,
/// Journal of Educational Statistics 6.
double hedges_correction(double df);

/// The share of variance of an effect beside its error, from its F: of any design. The interval
/// inverts the noncentral F: lambda / (lambda + df_effect + df_error + 1), Steiger 2004; within
/// participants it takes the conditions as spherical. Undefined where F is negative or not finite.
Defined<EffectSize> partial_eta_squared(double f, double df_effect, double df_error,
                                        double level = kProportionLevel);

/// In a one-way design the partial share is the share of all variance.
Defined<EffectSize> eta_squared(const Anova& anova, double level = kProportionLevel);

/// The share of an effect that compares between designs: squares / (squares + measured), or
/// squares / measured where the effect's factor was itself measured rather than manipulated.
/// @param measured  sum of the squares of every source that holds differences between people:
///                  participants, their interactions, errors, and measured factors.
/// Undefined without squares. Source: Olejnik and Algina 2003, Psychological Methods 8; Bakeman
/// 2005, Behavior Research Methods 37.
Defined<double> generalized_eta_squared(double squares, double measured, bool manipulated = true);

}  // namespace haptrial::analysis
