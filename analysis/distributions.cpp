#include "analysis/distributions.h"

#include <gsl/gsl_cdf.h>

namespace haptrial::analysis {

double f_upper_tail(double f, double df_numerator, double df_denominator) {
  return gsl_cdf_fdist_Q(f, df_numerator, df_denominator);
}

double t_upper_tail(double t, double df) { return gsl_cdf_tdist_Q(t, df); }

double t_quantile(double probability, double df) { return gsl_cdf_tdist_Pinv(probability, df); }

}  // namespace haptrial::analysis
