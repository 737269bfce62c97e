#pragma once

namespace haptrial::analysis {

/// Tails are right to 1e-11 of themselves up to a hundred thousand degrees of freedom. Beyond,
/// those under 1e-15 may come out as 0.

/// P(F > f) with the given degrees of freedom, which need not be integers; all > 0.
double f_upper_tail(double f, double df_numerator, double df_denominator);

/// P(T > t) of Student's t; df > 0.
double t_upper_tail(double t, double df);

/// The t with P(T < t) = probability; probability inside (0, 1), df > 0; to
/// full precision where the t lies below 1e150.
double t_quantile(double probability, double df);

/// P(Z > z) of the standard normal distribution.
double normal_upper_tail(double z);

/// The z with P(Z < z) = probability; probability inside (0, 1).
double normal_quantile(double probability);

/// P(X > x) of chi squared; df > 0.
double chi_squared_upper_tail(double x, double df);

}  // namespace haptrial::analysis
