#include "core/psychometric/function/sigmoid.h"

#include <gsl/gsl_cdf.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/text/nearest.h"

namespace haptrial::psychometric {
namespace {

constexpr std::array<SigmoidName, 11> kNames{{{"logistic", Sigmoid::kLogistic, false},
                                              {"cumulative_gaussian", Sigmoid::kGaussian, false},
                                              {"norm", Sigmoid::kGaussian, false},
                                              {"norm_cdf", Sigmoid::kGaussian, false},
                                              {"gumbel", Sigmoid::kGumbel, false},
                                              {"reversed_gumbel", Sigmoid::kReversedGumbel, false},
                                              {"rgumbel", Sigmoid::kReversedGumbel, false},
                                              {"tdist", Sigmoid::kCauchy, false},
                                              {"weibull", Sigmoid::kGumbel, true},
                                              {"log_normal", Sigmoid::kGaussian, true},
                                              {"logn", Sigmoid::kGaussian, true}}};

/// The sigmoid whose F(-z) is 1 - F(z) of this one.
Sigmoid mirrored(Sigmoid kind) noexcept {
  switch (kind) {
    case Sigmoid::kGumbel:
      return Sigmoid::kReversedGumbel;
    case Sigmoid::kReversedGumbel:
      return Sigmoid::kGumbel;
    default:
      return kind;
  }
}

double gumbel_density(double z) noexcept { return std::exp(z - std::exp(z)); }

}  // namespace

double sigmoid(Sigmoid kind, double z) noexcept {
  switch (kind) {
    case Sigmoid::kLogistic:
      return 1.0 / (1.0 + std::exp(-z));
    case Sigmoid::kGaussian:
      return 0.5 * std::erfc(-z / std::numbers::sqrt2);
    case Sigmoid::kGumbel:
      return -std::expm1(-std::exp(z));
    case Sigmoid::kReversedGumbel:
      return std::exp(-std::exp(-z));
    case Sigmoid::kCauchy:
      return std::atan2(1.0, -z) / std::numbers::pi;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double sigmoid_above(Sigmoid kind, double z) noexcept { return sigmoid(mirrored(kind), -z); }

double sigmoid_density(Sigmoid kind, double z) noexcept {
  switch (kind) {
    case Sigmoid::kLogistic:
      return sigmoid(kind, z) * sigmoid(kind, -z);
    case Sigmoid::kGaussian:
      return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    case Sigmoid::kGumbel:
      return gumbel_density(z);
    case Sigmoid::kReversedGumbel:
      return gumbel_density(-z);
    case Sigmoid::kCauchy:
      return 1.0 / (std::numbers::pi * (1.0 + z * z));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double sigmoid_quantile(Sigmoid kind, double p) {
  if (!(p > 0.0 && p < 1.0)) {
    throw std::invalid_argument("sigmoid_quantile: p must be between 0 and 1");
  }
  switch (kind) {
    case Sigmoid::kLogistic:
      return std::log(p) - std::log1p(-p);
    case Sigmoid::kGaussian:
      return gsl_cdf_ugaussian_Pinv(p);
    case Sigmoid::kGumbel:
      return std::log(-std::log1p(-p));
    case Sigmoid::kReversedGumbel:
      return -std::log(-std::log(p));
    case Sigmoid::kCauchy:
      return -1.0 / std::tan(std::numbers::pi * p);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::span<const SigmoidName> sigmoid_names() { return kNames; }

SigmoidName sigmoid_named(std::string_view name) {
  std::vector<std::string> allowed;
  for (const SigmoidName& known : kNames) {
    if (known.name == name) {
      return known;
    }
    allowed.emplace_back(known.name);
  }
  throw std::invalid_argument(
      not_allowed("the psychometric function", "'" + std::string(name) + "'", allowed));
}

}  // namespace haptrial::psychometric
