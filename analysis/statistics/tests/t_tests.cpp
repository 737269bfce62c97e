#include "analysis/statistics/tests/t_tests.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

double p_of_t(double t, double df, Tail tail) {
  switch (tail) {
    case Tail::kLess:
      return t_upper_tail(-t, df);
    case Tail::kGreater:
      return t_upper_tail(t, df);
    case Tail::kTwoSided:
      break;
  }
  return std::min(1.0, 2.0 * t_upper_tail(std::abs(t), df));
}

struct TwoSamples {
  Moments a;
  Moments b;
};

Defined<TwoSamples> two_samples(std::span<const double> a, std::span<const double> b) {
  const auto first = moments(a);
  const auto second = moments(b);
  if (!first || !second) {
    return Undefined{!first ? first.because() : second.because()};
  }
  if (first->squares == 0.0 && second->squares == 0.0) {
    return Undefined{"the values do not vary within either sample"};
  }
  return TwoSamples{*first, *second};
}

}  // namespace

Defined<TTest> t_test_of(double difference, double standard_error, double df, Tail tail,
                         double level) {
  const double t = difference / standard_error;
  if (!std::isfinite(t) || !std::isfinite(difference) || !(df > 0.0)) {
    return Undefined{kBeyondDouble};
  }
  const double half = t_quantile(0.5 + 0.5 * level, df) * standard_error;
  TTest result{t, df, p_of_t(t, df, tail), difference};
  result.low = difference - half;
  result.high = difference + half;
  result.error = standard_error;
  return result;
}

Defined<TTest> student_t_test(std::span<const double> a, std::span<const double> b, Tail tail,
                              double level) {
  const auto samples = two_samples(a, b);
  if (!samples) {
    return Undefined{samples.because()};
  }
  const auto& [ma, mb] = *samples;
  const auto na = static_cast<double>(ma.count);
  const auto nb = static_cast<double>(mb.count);
  const double df = na + nb - 2.0;  // > 0: single values do not vary
  const double pooled = (ma.squares + mb.squares) / df;
  return t_test_of(mean_difference(ma, mb), std::sqrt(pooled * (1.0 / na + 1.0 / nb)), df, tail,
                   level);
}

Defined<TTest> welch_t_test(std::span<const double> a, std::span<const double> b, Tail tail,
                            double level) {
  const auto samples = two_samples(a, b);
  if (!samples) {
    return Undefined{samples.because()};
  }
  const auto& [ma, mb] = *samples;
  if (ma.count < 2 || mb.count < 2) {
    return Undefined{"a sample has a single value"};
  }
  const auto na = static_cast<double>(ma.count);
  const auto nb = static_cast<double>(mb.count);
  const double va = ma.variance() / na;
  const double vb = mb.variance() / nb;
  const double df = (va + vb) * (va + vb) / (va * va / (na - 1.0) + vb * vb / (nb - 1.0));
  return t_test_of(mean_difference(ma, mb), std::sqrt(va + vb), df, tail, level);
}

Defined<TTest> paired_t_test(std::span<const double> a, std::span<const double> b, Tail tail,
                             double level) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("paired_t_test: the samples differ in length");
  }
  std::vector<double> differences(a.size());
  std::transform(a.begin(), a.end(), b.begin(), differences.begin(), std::minus<>{});
  const auto m = moments(differences);
  if (!m) {
    return Undefined{m.because()};
  }
  if (m->count < 2) {
    return Undefined{"there are fewer than two pairs"};
  }
  double largest = 0.0;  // rounding of the differences is relative to the values, not to them
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max({largest, std::abs(a[i]), std::abs(b[i])});
  }
  const auto n = static_cast<double>(m->count);
  const double unit = 4.0 * std::numeric_limits<double>::epsilon() * largest;
  if (m->squares <= n * unit * unit) {
    return Undefined{"the differences do not vary"};
  }
  return t_test_of(m->mean(), std::sqrt(m->variance() / n), n - 1.0, tail, level);
}

Defined<TTest> stratified_t_test(const std::vector<std::vector<double>>& a,
                                 const std::vector<std::vector<double>>& b, Tail tail,
                                 double level) {
  const auto strata = static_cast<double>(a.size());
  double difference = 0.0;
  double variance = 0.0;
  double spread = 0.0;  // of the variance
  for (const auto& [side, sign] : {std::pair{&a, 1.0}, std::pair{&b, -1.0}}) {
    for (const auto& stratum : *side) {
      const auto m = moments(stratum);
      if (!m) {
        return Undefined{m.because()};
      }
      if (m->count < 2) {
        return Undefined{"a group has a single participant"};
      }
      const double part = m->variance() / (static_cast<double>(m->count) * strata * strata);
      difference += sign * m->mean() / strata;
      variance += part;
      spread += part * part / static_cast<double>(m->count - 1);
    }
  }
  if (variance == 0.0) {
    return Undefined{"the values do not vary within any group"};
  }
  return t_test_of(difference, std::sqrt(variance), variance * variance / spread, tail, level);
}

EquivalenceTest equivalence_test(const TTest& test, double bound) {
  const double above = t_upper_tail((test.difference + bound) / test.error, test.df);
  const double below = t_upper_tail((bound - test.difference) / test.error, test.df);
  const double half = t_quantile(0.95, test.df) * test.error;
  return {bound, std::max(above, below), test.difference - half, test.difference + half};
}

namespace {

constexpr const char* kFewLeft = "trimming leaves fewer than two values";

/// A sample with its tails pulled in to the last values that are kept.
struct Winsorized {
  std::vector<double> values;  // as many and in the order of the sample
  double kept{0.0};            // number of values that trimming leaves
  double trimmed_mean{0.0};
};

Winsorized winsorized(std::span<const double> sample, double share) {
  std::vector<double> sorted(sample.begin(), sample.end());
  std::ranges::sort(sorted);
  const auto cut = static_cast<std::size_t>(share * static_cast<double>(sample.size()));
  const std::size_t kept = sample.size() - 2 * cut;
  Winsorized made{{sample.begin(), sample.end()}, static_cast<double>(kept), 0.0};
  const std::span<const double> middle(sorted.data() + cut, kept);
  const double low = middle.front(), high = middle.back();
  for (double& value : made.values) {
    value = std::clamp(value, low, high);
  }
  for (const double value : middle) {
    made.trimmed_mean += (value - low) / made.kept;
  }
  made.trimmed_mean += low;
  return made;
}

/// Sum of products of deviations from the means.
double products(const std::vector<double>& a, const Moments& of_a, const std::vector<double>& b,
                const Moments& of_b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - of_a.origin - of_a.offset) * (b[i] - of_b.origin - of_b.offset);
  }
  return sum;
}

}  // namespace

Defined<TTest> yuen_test(std::span<const double> a, std::span<const double> b, double share,
                         Tail tail, double level) {
  if (const auto ma = moments(a), mb = moments(b); !ma || !mb) {
    return Undefined{!ma ? ma.because() : mb.because()};
  }
  const Winsorized wa = winsorized(a, share), wb = winsorized(b, share);
  if (wa.kept < 2.0 || wb.kept < 2.0) {
    return Undefined{kFewLeft};
  }
  const double va = moments(wa.values)->squares / (wa.kept * (wa.kept - 1.0));
  const double vb = moments(wb.values)->squares / (wb.kept * (wb.kept - 1.0));
  if (va + vb == 0.0) {
    return Undefined{"the values that trimming leaves do not vary within either sample"};
  }
  const double df = (va + vb) * (va + vb) / (va * va / (wa.kept - 1.0) + vb * vb / (wb.kept - 1.0));
  return t_test_of(wa.trimmed_mean - wb.trimmed_mean, std::sqrt(va + vb), df, tail, level);
}

Defined<TTest> paired_yuen_test(std::span<const double> a, std::span<const double> b, double share,
                                Tail tail, double level) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("paired_yuen_test: the samples differ in length");
  }
  if (const auto ma = moments(a), mb = moments(b); !ma || !mb) {
    return Undefined{!ma ? ma.because() : mb.because()};
  }
  const Winsorized wa = winsorized(a, share), wb = winsorized(b, share);
  if (wa.kept < 2.0) {
    return Undefined{kFewLeft};
  }
  const Moments ma = *moments(wa.values), mb = *moments(wb.values);
  const double squares = ma.squares + mb.squares - 2.0 * products(wa.values, ma, wb.values, mb);
  if (!(squares > 1e-14 * (ma.squares + mb.squares))) {
    return Undefined{"the differences that trimming leaves do not vary"};
  }
  return t_test_of(wa.trimmed_mean - wb.trimmed_mean,
                   std::sqrt(squares / (wa.kept * (wa.kept - 1.0))), wa.kept - 1.0, tail, level);
}

namespace {

/// Share of the posterior of the effect that lies on a directed test's side, for a normal prior of
/// the effect whose variance is (spread - 1) / n: Student's t, as the scale is integrated out.
double share_on_side(double t, double df, double spread, Tail tail) {
  if (tail == Tail::kTwoSided) {
    return 0.5;
  }
  const double sum = df + t * t / spread;
  const double a = t * std::sqrt((1.0 - 1.0 / spread) * (df + 1.0) / sum);
  return t_upper_tail(tail == Tail::kGreater ? -a : a, df + 1.0);
}

}  // namespace

/// A Cauchy prior is a mixture of normal ones with variances (scale / u)², u from the half of a
/// standard normal distribution (Rouder et al. 2009, eq. 1); integrated over log u.
Defined<double> bayes_factor(double t, double df, double n, Tail tail, double scale) {
  constexpr double kLow = -40.0, kHigh = 3.0;  // of log u: beyond, nothing is left
  constexpr int kDepth = 12;                   // of halvings
  constexpr double kTolerance = 1e-10;
  const auto density = [&](double log_u) {
    const double u = std::exp(log_u);
    const double spread = 1.0 + n * (scale / u) * (scale / u);
    const double ratio =
        0.5 * (df + 1.0) * (std::log1p(t * t / df) - std::log1p(t * t / (df * spread))) -
        0.5 * std::log(spread);
    const double prior = std::sqrt(2.0 / M_PI) * std::exp(log_u - 0.5 * u * u + ratio);
    return prior > 0.0 ? 2.0 * share_on_side(t, df, spread, tail) * prior : 0.0;
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  const double factor = Rule::integrate(density, kLow, kHigh, kDepth, kTolerance);
  if (std::isfinite(factor) && factor > 0.0) {
    return factor;
  }
  return Undefined{"the integral over effects is not finite"};
}

}  // namespace haptrial::analysis
