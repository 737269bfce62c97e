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

/// x^a (1 - x)^b / B(a, b) to nearly full relative precision, also for large a and b; a, b > 0.
/// @param x, y  both in [0, 1], x + y = 1, given separately so that neither loses digits.
/// Source: the deviance form of Loader 2000, Fast and accurate computation of binomial
/// probabilities.
double beta_power(double a, double b, double x, double y);

/// e^-m m^k / Gamma(k + 1) for real k >= 0 and m > 0, in the same way.
double poisson_power(double k, double m);

/// The regularised incomplete beta function and its complement.
struct BetaTails {
  double lower{0.0};  // I_x(a, b)
  double upper{0.0};  // 1 - I_x(a, b)
};

/// The smaller tail keeps its relative precision. Continued fraction, modified Lentz's method.
BetaTails beta_tails(double a, double b, double x, double y);

}  // namespace haptrial::analysis
