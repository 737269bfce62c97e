#pragma once

#include "core/psychometric/function/axis.h"
#include "core/psychometric/function/sigmoid.h"

namespace haptrial::psychometric {

/// What a psychometric function is, stated once for procedures, fits, observers and predictions.
struct PsychometricParameters {
  Sigmoid sigmoid{Sigmoid::kLogistic};
  Axis axis;              // x of a level
  double threshold{0.0};  // the level at which F is `share` [unit of the level]
  double width{1.0};      // w > 0, from F = tail to F = 1 - tail [unit of the axis]
  double guess{0.0};      // lower asymptote, 0 <= guess
  double lapse{0.0};      // 1 - upper asymptote, 0 <= lapse, guess + lapse < 1
  double share{0.5};      // F at the threshold, 0 < share < 1; Watson's Weibull has 1 - 1/e
  double tail{0.05};      // 0 < tail < 1/2; psignifit 4 has 0.05
  bool falling{false};    // 1 - F in place of F
};

/// Probability of answer 1 ("correct", "yes", "stronger") at a level:
///
///     psi(level) = guess + (1 - guess - lapse) F(z)
///     z = q(share) + (q(1 - tail) - q(tail)) (x - m) / w,   q = F^-1, x and m on the axis
///
/// Source: Schütt, Harmeling, Macke, Wichmann 2016, Vision Research 122, eqs. 1 to 3.
class PsychometricFunction {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit PsychometricFunction(const PsychometricParameters& parameters);

  double operator()(double level) const noexcept { return at(parameters_.axis.at(level)); }
  double at(double x) const noexcept;              // x on the axis
  double derivative(double level) const noexcept;  // d psi / d level [1/unit of the level]
  double derivative_at(double x) const noexcept;   // d psi / dx [1/unit of the axis]

  /// The level for a probability.
  /// @throws std::invalid_argument unless the probability lies between both asymptotes.
  double level_for(double probability) const;
  double x_for(double probability) const;  // the same on the axis

  const PsychometricParameters& parameters() const noexcept { return parameters_; }

 private:
  double z_at(double x) const noexcept { return offset_ + rate_ * (x - middle_); }

  PsychometricParameters parameters_;
  double middle_;  // m [axis]
  double offset_;  // q(share)
  double rate_;    // dz/dx
};

/// Rates: z = rate (x - m) + constant.
///
///     rate = (q(1 - tail) - q(tail)) / width
///
/// A cumulative Gaussian has rate = 1 / sigma. A Weibull function of shape s, which QUEST+ calls
/// its slope, has rate = s ln 10 on a log10 axis and s ln 10 / 20 on an axis in dB.
/// @throws std::invalid_argument naming the argument that is out of its bounds
double rate_of_width(Sigmoid sigmoid, double width, double tail = 0.05);
double width_of_rate(Sigmoid sigmoid, double rate, double tail = 0.05);
double rate_of_weibull_shape(double shape, Scale scale);

/// The steepness of psi at its threshold, d psi / dx = (1 - guess - lapse) f(q(share)) rate, and
/// the width that gives it; psignifit 4 states slopes so. Positive also if the function falls.
double slope_at_threshold(const PsychometricParameters& parameters);
double width_for_slope(PsychometricParameters parameters, double slope);

}  // namespace haptrial::psychometric
