#include "analysis/psychometric/fit/sigmoid.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

constexpr double kPi = std::numbers::pi;

SigmoidPoint normal_point(double z) noexcept {
  // Of the smaller tail, and of its complement.
  const double tail = 0.5 * std::erfc(std::abs(z) * (0.5 * std::numbers::sqrt2));
  const double density =
      std::exp(-0.5 * z * z) * (0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2);
  const double share = z < 0.0 ? tail : 1.0 - tail;
  const double beyond = z < 0.0 ? 1.0 - tail : tail;
  return {share, beyond, density, -z * density};
}

SigmoidPoint logistic_point(double z) noexcept {
  const double e = std::exp(-std::abs(z));
  const double large = 1.0 / (1.0 + e);
  const double small = e * large;
  const double share = z < 0.0 ? small : large;
  const double beyond = z < 0.0 ? large : small;
  return {share, beyond, small * large, small * large * (beyond - share)};
}

SigmoidPoint gumbel_point(double z) noexcept {
  const double e = std::exp(std::min(z, 700.0));
  const double beyond = std::exp(-e);
  const double density = e * beyond;
  return {e < 0.5 ? -std::expm1(-e) : 1.0 - beyond, beyond, density, density - e * density};
}

SigmoidPoint student_point(double z) noexcept {
  const double tail =
      std::abs(z) > 1.0 ? std::atan(1.0 / std::abs(z)) / kPi : 0.5 - std::atan(std::abs(z)) / kPi;
  const double square = 1.0 + z * z;
  const double density = 1.0 / (kPi * square);
  return {z < 0.0 ? tail : 1.0 - tail, z < 0.0 ? 1.0 - tail : tail, density,
          -2.0 * z * density / square};
}

SigmoidPoint rising_point(SigmoidForm form, double z) noexcept {
  switch (form) {
    case SigmoidForm::kNormal:
      return normal_point(z);
    case SigmoidForm::kLogistic:
      return logistic_point(z);
    case SigmoidForm::kGumbel:
      return gumbel_point(z);
    case SigmoidForm::kReversedGumbel: {
      const SigmoidPoint mirrored = gumbel_point(-z);
      return {mirrored.beyond, mirrored.share, mirrored.density, -mirrored.bend};
    }
    case SigmoidForm::kStudent:
      break;
  }
  return student_point(z);
}

double rising_quantile(SigmoidForm form, double share) noexcept {
  switch (form) {
    case SigmoidForm::kNormal:
      return normal_quantile(share);
    case SigmoidForm::kLogistic:
      return std::log(share) - std::log1p(-share);
    case SigmoidForm::kGumbel:
      return std::log(-std::log1p(-share));
    case SigmoidForm::kReversedGumbel:
      return -std::log(-std::log(share));
    case SigmoidForm::kStudent:
      break;
  }
  return std::tan(kPi * (share - 0.5));
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

}  // namespace

SigmoidShape sigmoid_named(std::string_view name) {
  std::string plain = lower_case(name);
  SigmoidShape shape;
  if (plain.starts_with("neg_")) {
    shape.falling = true;
    plain.erase(0, 4);
  }
  const std::pair<const char*, std::pair<SigmoidForm, bool>> names[] = {
      {"norm", {SigmoidForm::kNormal, false}},
      {"gauss", {SigmoidForm::kNormal, false}},
      {"logistic", {SigmoidForm::kLogistic, false}},
      {"gumbel", {SigmoidForm::kGumbel, false}},
      {"rgumbel", {SigmoidForm::kReversedGumbel, false}},
      {"tdist", {SigmoidForm::kStudent, false}},
      {"logn", {SigmoidForm::kNormal, true}},
      {"weibull", {SigmoidForm::kGumbel, true}},
      {"rweibull", {SigmoidForm::kReversedGumbel, true}},
  };
  for (const auto& [known, meaning] : names) {
    if (plain == known) {
      shape.form = meaning.first;
      shape.logarithmic = meaning.second;
      return shape;
    }
  }
  throw std::invalid_argument("name of a sigmoid: \"" + std::string(name) +
                              "\"; allowed: norm, gauss, logistic, gumbel, rgumbel, tdist, logn, "
                              "Weibull, rWeibull, and neg_ before any of these");
}

Sigmoid::Sigmoid(const SigmoidShape& shape) : shape_(shape) {
  if (!(shape.threshold_share > 0.0 && shape.threshold_share < 1.0)) {
    throw std::invalid_argument("threshold_share must lie inside (0, 1)");
  }
  if (!(shape.width_tail > 0.0 && shape.width_tail < 0.5)) {
    throw std::invalid_argument("width_tail must lie inside (0, 0.5)");
  }
  centre_ = rising_quantile(shape.form,
                            shape.falling ? 1.0 - shape.threshold_share : shape.threshold_share);
  spread_ = rising_quantile(shape.form, 1.0 - shape.width_tail) -
            rising_quantile(shape.form, shape.width_tail);
}

double Sigmoid::coordinate(double level) const noexcept {
  return shape_.logarithmic ? std::log(level) : level;
}

double Sigmoid::level(double coordinate) const noexcept {
  return shape_.logarithmic ? std::exp(coordinate) : coordinate;
}

SigmoidPoint Sigmoid::at(double z) const noexcept {
  const SigmoidPoint p = rising_point(shape_.form, z);
  if (shape_.falling) {
    return {p.beyond, p.share, -p.density, -p.bend};
  }
  return p;
}

double Sigmoid::share(double x, double threshold, double width, double& beyond) const noexcept {
  const SigmoidPoint p = at(centre_ + spread_ * (x - threshold) / width);
  beyond = p.beyond;
  return p.share;
}

double Sigmoid::inverse(double share, double threshold, double width) const noexcept {
  const double z = rising_quantile(shape_.form, shape_.falling ? 1.0 - share : share);
  return threshold + width * (z - centre_) / spread_;
}

double Sigmoid::slope(double x, double threshold, double width) const noexcept {
  return at(centre_ + spread_ * (x - threshold) / width).density * spread_ / width;
}

}  // namespace haptrial::analysis
