#include "analysis/statistics/tests/t_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

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

}  // namespace haptrial::analysis
