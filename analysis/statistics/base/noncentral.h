#pragma once

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// P(T < t) and P(T > t), each computed by itself.
struct Tails {
  double lower{0.0};
  double upper{0.0};
};

/// Noncentral t: (Z + delta) / sqrt(chi²(df) / df); df > 0, both finite.
/// The absolute error is below 1e-13. Source: Lenth 1989, Algorithm AS 243, Applied Statistics 38,
/// summed from beyond the largest Poisson weight so that every recurrence only adds.
Tails noncentral_t(double t, double df, double delta);

/// Noncentral F with noncentrality lambda >= 0 of the numerator; f >= 0, both df > 0.
/// The absolute error is below 1e-13. Source: Benton and Krishnamoorthy 2003, Computational
/// Statistics and Data Analysis 43.
Tails noncentral_f(double f, double df_numerator, double df_denominator, double lambda);

/// The noncentralities for which the statistic found lies at either end of its central `level`.
struct NoncentralityLimits {
  double low{0.0};
  double high{0.0};
};

/// Undefined where t² is above 1e9: the limits would take too long.
Defined<NoncentralityLimits> noncentral_t_limits(double t, double df, double level);

/// A limit is 0 where no noncentrality puts f at that end. Undefined where f times df_numerator is
/// above 1e9.
Defined<NoncentralityLimits> noncentral_f_limits(double f, double df_numerator,
                                                 double df_denominator, double level);

}  // namespace haptrial::analysis
