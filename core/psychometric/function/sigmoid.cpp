#include "core/psychometric/function/sigmoid.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/nearest.h"

namespace haptrial::psychometric {
namespace {

constexpr double kNormalScale = 0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2;

/// A quotient of polynomials: pairs of coefficients, numerator and denominator side by side, from
/// the highest power down.
template <std::size_t N>
double quotient(const double (&pairs)[N][2], double x) noexcept {
  double top = pairs[0][0], bottom = pairs[0][1];
  for (std::size_t i = 1; i < N; ++i) {
    top = top * x + pairs[i][0];
    bottom = bottom * x + pairs[i][1];
  }
  return top / bottom;
}

// Coefficients of erf(x) / x below 0.46875, of exp(x^2) erfc(x) up to 4, and beyond: Cody 1969,
// Mathematics of Computation 23. The exponential is that of the density.
constexpr double kNear[][2] = {{1.85777706184603153e-1, 1.0},
                               {3.16112374387056560, 2.36012909523441209e1},
                               {1.13864154151050156e2, 2.44024637934444173e2},
                               {3.77485237685302021e2, 1.28261652607737228e3},
                               {3.20937758913846947e3, 2.84423683343917062e3}};
constexpr double kMiddle[][2] = {{2.15311535474403846e-8, 1.0},
                                 {5.64188496988670089e-1, 1.57449261107098347e1},
                                 {8.88314979438837594, 1.17693950891312499e2},
                                 {6.61191906371416295e1, 5.37181101862009858e2},
                                 {2.98635138197400131e2, 1.62138957456669019e3},
                                 {8.81952221241769090e2, 3.29079923573345963e3},
                                 {1.71204761263407058e3, 4.36261909014324716e3},
                                 {2.05107837782607147e3, 3.43936767414372164e3},
                                 {1.23033935479799725e3, 1.23033935480374942e3}};
constexpr double kFar[][2] = {{1.63153871373020978e-2, 1.0},
                              {3.05326634961232344e-1, 2.56852019228982242},
                              {3.60344899949804439e-1, 1.87295284992346725},
                              {1.25781726111229246e-1, 5.27905102951428412e-1},
                              {1.60837851487422766e-2, 6.05183413124413191e-2},
                              {6.58749161529837803e-4, 2.33520497626869185e-3}};

/// P(Z > |z|). @param gauss  exp(-z^2 / 2)
double normal_tail(double z, double gauss) noexcept {
  const double x = std::abs(z) * (0.5 * std::numbers::sqrt2);
  if (x <= 0.46875) {
    return 0.5 - 0.5 * x * quotient(kNear, x * x);
  }
  if (x <= 4.0) {
    return 0.5 * gauss * quotient(kMiddle, x);
  }
  const double y = 1.0 / (x * x);
  return 0.5 * gauss / x * (std::numbers::inv_sqrtpi - y * quotient(kFar, y));
}

SigmoidPoint normal_point(double z) noexcept {
  const double gauss = std::exp(-0.5 * z * z);
  const double tail = std::abs(z) < 1e8 ? normal_tail(z, gauss) : gauss;
  const double density = kNormalScale * gauss;
  return {z < 0.0 ? tail : 1.0 - tail, z < 0.0 ? 1.0 - tail : tail, density, -z * density};
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

SigmoidPoint cauchy_point(double z) noexcept {
  const double tail = std::abs(z) > 1.0 ? std::atan(1.0 / std::abs(z)) / std::numbers::pi
                                        : 0.5 - std::atan(std::abs(z)) / std::numbers::pi;
  const double square = 1.0 + z * z;
  const double density = 1.0 / (std::numbers::pi * square);
  return {z < 0.0 ? tail : 1.0 - tail, z < 0.0 ? 1.0 - tail : tail, density,
          -2.0 * z * density / square};
}

inline SigmoidPoint point_of(Sigmoid kind, double z) noexcept {
  switch (kind) {
    case Sigmoid::kLogistic:
      return logistic_point(z);
    case Sigmoid::kGaussian:
      return normal_point(z);
    case Sigmoid::kGumbel:
      return gumbel_point(z);
    case Sigmoid::kReversedGumbel: {
      const SigmoidPoint mirrored = gumbel_point(-z);
      return {mirrored.beyond, mirrored.share, mirrored.density, -mirrored.bend};
    }
    case Sigmoid::kCauchy:
      break;
  }
  return cauchy_point(z);
}

void put_point(const SigmoidPoint& point, std::size_t i, SigmoidLanes& lanes) noexcept {
  lanes.share[i] = point.share;
  lanes.beyond[i] = point.beyond;
  lanes.density[i] = point.density;
  lanes.bend[i] = point.bend;
}

// The loops over the lanes have no branch, so that the compiler turns them into vectors. The middle
// quotient is right to 5e-12 down to 0.
void normal_lanes(const double* z, SigmoidLanes& lanes) noexcept {
  constexpr std::size_t kCount = SigmoidLanes::kCount;
  constexpr double kMiddleEnd = 5.6;  // 4 sqrt 2
  double gauss[kCount], farthest = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    gauss[i] = std::exp(-0.5 * z[i] * z[i]);
    farthest = std::max(farthest, std::abs(z[i]));
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const double x = std::abs(z[i]) * (0.5 * std::numbers::sqrt2);
    const double tail = 0.5 * gauss[i] * quotient(kMiddle, x);
    lanes.share[i] = z[i] < 0.0 ? tail : 1.0 - tail;
    lanes.beyond[i] = z[i] < 0.0 ? 1.0 - tail : tail;
    lanes.density[i] = kNormalScale * gauss[i];
    lanes.bend[i] = -z[i] * lanes.density[i];
  }
  for (std::size_t i = 0; farthest > kMiddleEnd && i < kCount; ++i) {
    if (std::abs(z[i]) > kMiddleEnd) {
      put_point(normal_point(z[i]), i, lanes);
    }
  }
}

void logistic_lanes(const double* z, SigmoidLanes& lanes) noexcept {
  constexpr std::size_t kCount = SigmoidLanes::kCount;
  double e[kCount];
  for (std::size_t i = 0; i < kCount; ++i) {
    e[i] = std::exp(-std::abs(z[i]));
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const double large = 1.0 / (1.0 + e[i]), small = e[i] * large;
    lanes.share[i] = z[i] < 0.0 ? small : large;
    lanes.beyond[i] = z[i] < 0.0 ? large : small;
    lanes.density[i] = small * large;
    lanes.bend[i] = small * large * (lanes.beyond[i] - lanes.share[i]);
  }
}

}  // namespace

SigmoidPoint sigmoid_point(Sigmoid kind, double z) noexcept { return point_of(kind, z); }

void sigmoid_lanes(Sigmoid kind, const double* z, SigmoidLanes& lanes) noexcept {
  if (kind == Sigmoid::kGaussian) {
    normal_lanes(z, lanes);
  } else if (kind == Sigmoid::kLogistic) {
    logistic_lanes(z, lanes);
  } else {
    for (std::size_t i = 0; i < SigmoidLanes::kCount; ++i) {
      put_point(point_of(kind, z[i]), i, lanes);
    }
  }
}

double sigmoid(Sigmoid kind, double z) noexcept { return point_of(kind, z).share; }

double sigmoid_above(Sigmoid kind, double z) noexcept { return point_of(kind, z).beyond; }

double sigmoid_density(Sigmoid kind, double z) noexcept { return point_of(kind, z).density; }

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

namespace {

constexpr std::string_view kFalling = "neg_";

constexpr std::array<SigmoidName, 13> kNames{{{"logistic", {Sigmoid::kLogistic}},
                                              {"cumulative_gaussian", {Sigmoid::kGaussian}},
                                              {"norm", {Sigmoid::kGaussian}},
                                              {"gauss", {Sigmoid::kGaussian}},
                                              {"norm_cdf", {Sigmoid::kGaussian}},
                                              {"gumbel", {Sigmoid::kGumbel}},
                                              {"reversed_gumbel", {Sigmoid::kReversedGumbel}},
                                              {"rgumbel", {Sigmoid::kReversedGumbel}},
                                              {"tdist", {Sigmoid::kCauchy}},
                                              {"weibull", {Sigmoid::kGumbel, true}},
                                              {"rweibull", {Sigmoid::kReversedGumbel, true}},
                                              {"log_normal", {Sigmoid::kGaussian, true}},
                                              {"logn", {Sigmoid::kGaussian, true}}}};

std::string in_small_letters(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

}  // namespace

std::span<const SigmoidName> sigmoid_names() { return kNames; }

SigmoidForm sigmoid_named(std::string_view name) {
  const std::string small = in_small_letters(name);
  std::string_view plain = small;
  const bool falling = plain.starts_with(kFalling);
  plain.remove_prefix(falling ? kFalling.size() : 0);
  std::vector<std::string> allowed;
  for (const SigmoidName& known : kNames) {
    if (known.name == plain) {
      SigmoidForm form = known.form;
      form.falling = falling;
      return form;
    }
    allowed.emplace_back((falling ? std::string(kFalling) : "").append(known.name));
  }
  throw std::invalid_argument(
      not_allowed("the psychometric function", "'" + std::string(name) + "'", allowed) +
      (falling ? "" : ", and neg_ before each of these"));
}

namespace {

SigmoidPoint turned(const SigmoidPoint& p) noexcept {
  return {p.beyond, p.share, -p.density, -p.bend};
}

}  // namespace

SigmoidCurve::SigmoidCurve(Sigmoid sigmoid, double share, double tail, bool falling)
    : sigmoid_(sigmoid), falling_(falling) {
  if (!(share > 0.0 && share < 1.0)) {
    throw std::invalid_argument("share must be between 0 and 1");
  }
  if (!(tail > 0.0 && tail < 0.5)) {
    throw std::invalid_argument("tail must be between 0 and 0.5");
  }
  centre_ = z_for(share);
  spread_ = sigmoid_quantile(sigmoid, 1.0 - tail) - sigmoid_quantile(sigmoid, tail);
}

SigmoidPoint SigmoidCurve::at(double z) const noexcept {
  const SigmoidPoint rising = sigmoid_point(sigmoid_, z);
  return falling_ ? turned(rising) : rising;
}

void SigmoidCurve::at(const double* z, SigmoidLanes& lanes) const noexcept {
  sigmoid_lanes(sigmoid_, z, lanes);
  for (std::size_t i = 0; falling_ && i < SigmoidLanes::kCount; ++i) {
    const SigmoidPoint p =
        turned({lanes.share[i], lanes.beyond[i], lanes.density[i], lanes.bend[i]});
    lanes.share[i] = p.share;
    lanes.beyond[i] = p.beyond;
    lanes.density[i] = p.density;
    lanes.bend[i] = p.bend;
  }
}

double SigmoidCurve::z_for(double share) const {
  return sigmoid_quantile(sigmoid_, falling_ ? 1.0 - share : share);
}

}  // namespace haptrial::psychometric
