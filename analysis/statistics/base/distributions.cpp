#include "analysis/statistics/base/distributions.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>

#include <algorithm>
#include <cmath>

namespace haptrial::analysis {

double f_upper_tail(double f, double df_numerator, double df_denominator) {
  return gsl_cdf_fdist_Q(f, df_numerator, df_denominator);
}

// GSL's own tail of t is an expansion above 30 degrees of freedom, wrong by 1e-8 of itself far out;
// T squared is F.
double t_upper_tail(double t, double df) {
  const double tail = 0.5 * gsl_cdf_fdist_Q(t * t, 1.0, df);
  return t < 0.0 ? 1.0 - tail : tail;
}

// GSL's quantile has about seven digits, and fewer far out. Newton's steps add the rest: in the
// logarithms of the tail and of t, where the curve bends one way only, they cannot go astray.
double t_quantile(double probability, double df) {
  if (probability == 0.5) {
    return 0.0;
  }
  const double tail = std::min(probability, 1.0 - probability);
  double t = gsl_cdf_tdist_Qinv(tail, df);
  if (!(t > 0.0) || !std::isfinite(t)) {
    t = 1.0;
  }
  for (int i = 0; i < 500; ++i) {
    const double found = t_upper_tail(t, df);
    const double slope = t * gsl_ran_tdist_pdf(t, df) / found;
    const double step = found > 0.0 ? std::clamp(std::log(found / tail) / slope, -1.0, 1.0) : -1.0;
    t *= std::exp(step);
    if (std::abs(step) < 1e-15) {
      break;
    }
  }
  return probability < 0.5 ? -t : t;
}

double normal_upper_tail(double z) { return gsl_cdf_ugaussian_Q(z); }

double normal_quantile(double probability) { return gsl_cdf_ugaussian_Pinv(probability); }

double chi_squared_upper_tail(double x, double df) { return gsl_cdf_chisq_Q(x, df); }

}  // namespace haptrial::analysis
