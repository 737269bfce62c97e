#include "core/psychometric/function/psychometric_function.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace haptrial::psychometric {
namespace {

// A fit makes many functions, so no text is put together unless it is needed.
void require(bool holds, const char* sentence) {
  if (!holds) {
    throw std::invalid_argument(std::string("PsychometricFunction: ") + sentence);
  }
}

bool positive(double value) { return value > 0.0 && std::isfinite(value); }

PsychometricParameters with_threshold(PsychometricParameters p, double x) {
  p.threshold = p.axis.level(x);
  return p;
}

double threshold_x(const PsychometricParameters& p) {
  require(std::isfinite(p.threshold), "threshold must be finite");
  const double x = p.axis.at(p.threshold);
  require(std::isfinite(x), "threshold must be above the origin of a logarithmic scale");
  return x;
}

const PsychometricParameters& checked(const PsychometricParameters& p) {
  require(std::isfinite(p.axis.origin), "origin must be finite");
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
  return SigmoidCurve(sigmoid, 0.5, tail, false).spread();
}

}  // namespace

PsychometricParameters parameters_named(std::string_view name, double guess) {
  PsychometricParameters parameters;
  set_sigmoid(parameters, name, Scale::kNaturalLog);
  parameters.guess = guess;
  return parameters;
}

void set_sigmoid(PsychometricParameters& parameters, std::string_view name, Scale logarithmic) {
  const SigmoidForm form = sigmoid_named(name);
  parameters.sigmoid = form.sigmoid;
  parameters.falling = form.falling;
  if (form.logarithmic && parameters.axis.scale == Scale::kLinear) {
    parameters.axis.scale = logarithmic;
  }
}

SigmoidCurve curve_of(const PsychometricParameters& p) {
  return {p.sigmoid, p.share, p.tail, p.falling};
}

PsychometricFunction::PsychometricFunction(const PsychometricParameters& parameters)
    : parameters_(checked(parameters)),
      curve_(curve_of(parameters)),
      middle_(threshold_x(parameters)),
      rate_(curve_.spread() / parameters.width) {}

PsychometricFunction::PsychometricFunction(const PsychometricParameters& parameters,
                                           const SigmoidCurve& curve, double x)
    : parameters_(with_threshold(checked(parameters), x)),
      curve_(curve),
      middle_(x),
      rate_(curve.spread() / parameters.width) {
  require(std::isfinite(x), "threshold must be finite");
}

double PsychometricFunction::at(double x) const noexcept {
  const auto& p = parameters_;
  return p.guess + (1.0 - p.guess - p.lapse) * curve_.at(z_at(x)).share;
}

double PsychometricFunction::derivative(double level) const noexcept {
  const auto& p = parameters_;
  const double x = p.axis.at(level);
  // Far below the threshold the density is 0 before the axis ends.
  const double slope = (1.0 - p.guess - p.lapse) * rate_ * curve_.at(z_at(x)).density;
  return slope == 0.0 || !std::isfinite(x) ? 0.0 : slope * p.axis.gradient(level);
}

double PsychometricFunction::x_for_share(double share) const {
  return middle_ + (curve_.z_for(share) - curve_.centre()) / rate_;
}

double PsychometricFunction::x_for(double probability) const {
  const auto& p = parameters_;
  require(probability > p.guess && probability < 1.0 - p.lapse,
          "probability must be between guess and 1 - lapse");
  return x_for_share((probability - p.guess) / (1.0 - p.guess - p.lapse));
}

double PsychometricFunction::level_for(double probability) const {
  return parameters_.axis.level(x_for(probability));
}

double PsychometricFunction::level_for_share(double share) const {
  return parameters_.axis.level(x_for_share(share));
}

double rate_of_width(Sigmoid sigmoid, double width, double tail) {
  require(positive(width), "width must be finite and above 0");
  return spread(sigmoid, tail) / width;
}

double width_of_rate(Sigmoid sigmoid, double rate, double tail) {
  require(positive(rate), "rate must be finite and above 0");
  return spread(sigmoid, tail) / rate;
}

}  // namespace haptrial::psychometric
