#include "analysis/statistics/tests/spending_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

constexpr double kFarthest = 9.0;      // standard deviations that the density is followed
constexpr int kSteps = 300;            // of the density; even, for Simpson's rule
constexpr double kLeastSpent = 1e-15;  // less than this is no bound

/// The part of a one-sided error that is spent by then.
double spent(double share, double error, Spending spending) {
  if (spending == Spending::kPocock) {
    return error * std::log1p((std::numbers::e - 1.0) * share);
  }
  return 2.0 * normal_upper_tail(normal_quantile(1.0 - error / 2.0) / std::sqrt(share));
}

double normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

/// The density of the sum on the part where the study goes on.
struct Going {
  double low{0.0}, high{0.0};
  std::vector<double> density;  // in equal steps from low to high; empty: all is at 0

  double at(std::size_t i) const {
    return low + (high - low) * static_cast<double>(i) / static_cast<double>(kSteps);
  }
  template <class F>
  double integral(F&& f) const {
    if (density.empty()) {
      return f(0.0);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < density.size(); ++i) {
      const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      sum += weight * density[i] * f(at(i));
    }
    return sum * (high - low) / kSteps / 3.0;
  }
};

/// Probability that the sum goes beyond a bound at the next look.
double probability_beyond(const Going& going, double bound, double deviation) {
  return going.integral([&](double x) { return normal_upper_tail((bound - x) / deviation); });
}

Going after_look(const Going& before, double bound, double share, double deviation,
                 bool two_sided) {
  const double far = kFarthest * std::sqrt(share);
  Going after;
  after.high = std::min(bound, far);
  after.low = two_sided ? -after.high : -far;
  after.density.resize(kSteps + 1);
  for (std::size_t i = 0; i < after.density.size(); ++i) {
    const double x = after.at(i);
    after.density[i] = before.integral(
        [&](double from) { return normal_density((x - from) / deviation) / deviation; });
  }
  return after;
}

void check_shares(std::span<const double> shares, double error) {
  double before = 0.0;
  for (const double share : shares) {
    if (!(share > before && share <= 1.0)) {
      throw std::invalid_argument("shares of a study ascend from above 0 to at most 1");
    }
    before = share;
  }
  if (!(error > 0.0 && error < 0.5)) {
    throw std::invalid_argument("an error is above 0 and below 0.5");
  }
}

}  // namespace

std::vector<double> spending_bounds(std::span<const double> shares, double error, bool two_sided,
                                    Spending spending) {
  check_shares(shares, error);
  const double one_sided = two_sided ? error / 2.0 : error;
  std::vector<double> bounds;
  Going going;
  double share_before = 0.0, spent_before = 0.0;
  for (const double share : shares) {
    const double deviation = std::sqrt(share - share_before);
    const double spent_now = spent(share, one_sided, spending);
    const double to_spend = spent_now - spent_before;
    const double far = kFarthest * std::sqrt(share);
    double bound = std::numeric_limits<double>::infinity();
    if (to_spend > kLeastSpent) {
      bound = find_root(
          [&](double b) { return probability_beyond(going, b, deviation) - to_spend; }, -far, far);
      spent_before = spent_now;
    }
    bounds.push_back(bound / std::sqrt(share));
    going = after_look(going, bound, share, deviation, two_sided);
    share_before = share;
  }
  return bounds;
}

}  // namespace haptrial::analysis
