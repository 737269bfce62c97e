#pragma once

namespace haptrial::analysis {

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
