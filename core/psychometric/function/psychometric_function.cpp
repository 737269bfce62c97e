#include "core/psychometric/function/psychometric_function.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptrial::psychometric {
namespace {

void require(bool holds, const std::string& sentence) {
  if (!holds) {
    throw std::invalid_argument("PsychometricFunction: " + sentence);
  }
}

bool positive(double value) { return value > 0.0 && std::isfinite(value); }

const PsychometricParameters& checked(const PsychometricParameters& p) {
  require(std::isfinite(p.axis.origin), "origin must be finite");
  require(std::isfinite(p.threshold), "threshold must be finite");
  require(std::isfinite(p.axis.at(p.threshold)),
          "threshold must be above the origin of a logarithmic scale");
  require(positive(p.width), "width must be finite and above 0");
  require(p.guess >= 0.0, "guess must be at least 0");
  require(p.lapse >= 0.0, "lapse must be at least 0");
  require(p.guess + p.lapse < 1.0, "guess and lapse must add up to less than 1");
  require(p.share > 0.0 && p.share < 1.0, "share must be between 0 and 1");
  require(p.tail > 0.0 && p.tail < 0.5, "tail must be between 0 and 0.5");
  return p;
}

double spread(Sigmoid sigmoid, double tail) {
  require(tail > 0.0 && tail < 0.5, "tail must be between 0 and 0.5");
  return sigmoid_quantile(sigmoid, 1.0 - tail) - sigmoid_quantile(sigmoid, tail);
}

double steepness(const PsychometricParameters& p) {
  return (1.0 - p.guess - p.lapse) *
         sigmoid_density(p.sigmoid, sigmoid_quantile(p.sigmoid, p.share));
}

}  // namespace

PsychometricFunction::PsychometricFunction(const PsychometricParameters& parameters)
    : parameters_(checked(parameters)),
      middle_(parameters.axis.at(parameters.threshold)),
      offset_(sigmoid_quantile(parameters.sigmoid, parameters.share)),
      rate_(rate_of_width(parameters.sigmoid, parameters.width, parameters.tail)) {}

double PsychometricFunction::at(double x) const noexcept {
  const auto& p = parameters_;
  const double z = z_at(x);
  const double share = p.falling ? sigmoid_above(p.sigmoid, z) : sigmoid(p.sigmoid, z);
  return p.guess + (1.0 - p.guess - p.lapse) * share;
}

double PsychometricFunction::derivative_at(double x) const noexcept {
  const auto& p = parameters_;
  const double rising = (1.0 - p.guess - p.lapse) * rate_ * sigmoid_density(p.sigmoid, z_at(x));
  return p.falling ? -rising : rising;
}

double PsychometricFunction::derivative(double level) const noexcept {
  const double x = parameters_.axis.at(level);
  // Far below the threshold the density is 0 before the axis ends.
  const double slope = derivative_at(x);
  return slope == 0.0 || !std::isfinite(x) ? 0.0 : slope * parameters_.axis.gradient(level);
}

double PsychometricFunction::x_for(double probability) const {
  const auto& p = parameters_;
  require(probability > p.guess && probability < 1.0 - p.lapse,
          "probability must be between guess and 1 - lapse");
  const double above = 1.0 - p.lapse - probability;
  const double below = probability - p.guess;
  const double share = (p.falling ? above : below) / (1.0 - p.guess - p.lapse);
  return middle_ + (sigmoid_quantile(p.sigmoid, share) - offset_) / rate_;
}

double PsychometricFunction::level_for(double probability) const {
  return parameters_.axis.level(x_for(probability));
}

double rate_of_width(Sigmoid sigmoid, double width, double tail) {
  require(positive(width), "width must be finite and above 0");
  return spread(sigmoid, tail) / width;
}

double width_of_rate(Sigmoid sigmoid, double rate, double tail) {
  require(positive(rate), "rate must be finite and above 0");
  return spread(sigmoid, tail) / rate;
}

double rate_of_weibull_shape(double shape, Scale scale) {
  require(positive(shape), "shape must be finite and above 0");
  require(scale != Scale::kLinear, "a Weibull function needs a logarithmic scale");
  return shape * std::numbers::ln10 / (scale == Scale::kDecibel ? 20.0 : 1.0);
}

double slope_at_threshold(const PsychometricParameters& parameters) {
  const auto& p = checked(parameters);
  return steepness(p) * rate_of_width(p.sigmoid, p.width, p.tail);
}

double width_for_slope(PsychometricParameters parameters, double slope) {
  require(positive(slope), "slope must be finite and above 0");
  parameters.width = 1.0;
  return slope_at_threshold(parameters) / slope;
}

}  // namespace haptrial::psychometric
