#include "analysis/statistics/variance/effect_size.h"

#include <gsl/gsl_sf_gamma.h>

#include <cmath>
#include <utility>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {
namespace {

// The standardised difference is t times `scale`, and so are its limits.
Defined<EffectSize> standardised(const Defined<TTest>& test, double scale, double level) {
  if (!test) {
    return Undefined{test.because()};
  }
  const auto limits = noncentral_t_limits(test->t, test->df, level);
  if (!limits) {
    return Undefined{limits.because()};
  }
  return EffectSize{test->t * scale, limits->low * scale, limits->high * scale, level};
}

double two_sample_scale(std::size_t a, std::size_t b) {
  return std::sqrt(1.0 / static_cast<double>(a) + 1.0 / static_cast<double>(b));
}

}  // namespace

Defined<EffectSize> cohens_d(std::span<const double> a, std::span<const double> b, double level) {
  return standardised(student_t_test(a, b, Tail::kTwoSided), two_sample_scale(a.size(), b.size()),
                      level);
}

Defined<EffectSize> cohens_dz(std::span<const double> a, std::span<const double> b, double level) {
  return standardised(paired_t_test(a, b, Tail::kTwoSided),
                      1.0 / std::sqrt(static_cast<double>(a.size())), level);
}

Defined<EffectSize> stratified_d(const std::vector<std::vector<double>>& a,
                                 const std::vector<std::vector<double>>& b, double level) {
  const auto strata = static_cast<double>(a.size());
  double difference = 0.0, squares = 0.0, df = 0.0;
  double weight = 0.0;  // of one value's variance in that of the difference
  for (const auto& [side, sign] : {std::pair{&a, 1.0}, std::pair{&b, -1.0}}) {
    for (const auto& stratum : *side) {
      const auto m = moments(stratum);
      if (!m) {
        return Undefined{m.because()};
      }
      difference += sign * m->mean() / strata;
      squares += m->squares;
      df += static_cast<double>(m->count) - 1.0;
      weight += 1.0 / (static_cast<double>(m->count) * strata * strata);
    }
  }
  if (squares == 0.0) {
    return Undefined{"the values do not vary within any group"};
  }
  const double d = difference / std::sqrt(squares / df);
  const auto limits = noncentral_t_limits(d / std::sqrt(weight), df, level);
  if (!limits) {
    return Undefined{limits.because()};
  }
  return EffectSize{d, limits->low * std::sqrt(weight), limits->high * std::sqrt(weight), level};
}

Defined<EffectSize> hedges_g(std::span<const double> a, std::span<const double> b, double level) {
  const auto d = cohens_d(a, b, level);
  if (!d) {
    return Undefined{d.because()};
  }
  const auto df = static_cast<double>(a.size() + b.size()) - 2.0;
  if (df <= 1.0) {
    return Undefined{"three values are too few to remove the bias"};
  }
  return EffectSize{d->value * hedges_correction(df), d->low, d->high, level};
}

double hedges_correction(double df) {
  // Gamma by its ratio to Stirling's formula: no large logarithms are subtracted.
  const double a = 0.5 * df;
  const double b = a - 0.5;
  const double power = a * std::log1p(-0.5 / a);  // log of (b / a)^a
  return std::exp(-power - 0.5) * (b / a) * (gsl_sf_gammastar(a) / gsl_sf_gammastar(b));
}

Defined<EffectSize> partial_eta_squared(double f, double df_effect, double df_error, double level) {
  if (!(std::isfinite(f) && f >= 0.0 && df_effect > 0.0 && df_error > 0.0)) {
    return Undefined{"there is no F to take it from"};
  }
  const auto limits = noncentral_f_limits(f, df_effect, df_error, level);
  if (!limits) {
    return Undefined{limits.because()};
  }
  const double cases = df_effect + df_error + 1.0;
  return EffectSize{f * df_effect / (f * df_effect + df_error), limits->low / (limits->low + cases),
                    limits->high / (limits->high + cases), level};
}

Defined<EffectSize> eta_squared(const Anova& anova, double level) {
  return partial_eta_squared(anova.f, anova.df_between, anova.df_within, level);
}

Defined<double> generalized_eta_squared(double squares, double measured, bool manipulated) {
  const double whole = measured + (manipulated ? squares : 0.0);
  if (!std::isfinite(squares) || !std::isfinite(measured) || squares < 0.0 || !(whole > 0.0)) {
    return Undefined{"there are no squares to take a share of"};
  }
  return squares / whole;
}

}  // namespace haptrial::analysis
