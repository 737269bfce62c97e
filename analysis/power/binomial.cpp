#include "analysis/power/binomial.h"

#include <gsl/gsl_cdf.h>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

/// Quantile of a beta distribution: its lower tail there is `probability`. GSL's inverse may not
/// converge.
double beta_quantile(double a, double b, double probability) {
  return find_root([&](double x) { return beta_tails(a, b, x, 1.0 - x).lower - probability; }, 0.0,
                   1.0);
}

}  // namespace

Share share_of(std::size_t found, std::size_t of, double level) {
  const double rest = 0.5 * (1.0 - level);
  const auto k = static_cast<double>(found), n = static_cast<double>(of);
  Share share{k / n};
  share.low = found == 0 ? 0.0 : beta_quantile(k, n - k + 1.0, rest);
  share.high = found == of ? 1.0 : beta_quantile(k + 1.0, n - k, 1.0 - rest);
  return share;
}

CountBand binomial_band(std::size_t of, double p, double level) {
  const auto n = static_cast<unsigned>(of);
  const double rest = 0.5 * (1.0 - level);
  CountBand band{0, of};
  while (band.low < of && gsl_cdf_binomial_P(static_cast<unsigned>(band.low), p, n) < rest) {
    ++band.low;
  }
  while (band.high > 0 && gsl_cdf_binomial_Q(static_cast<unsigned>(band.high - 1), p, n) < rest) {
    --band.high;
  }
  return band;
}

}  // namespace haptrial::analysis
