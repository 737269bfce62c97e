#pragma once

#include <string_view>

#include "core/psychometric/function/axis.h"
#include "core/psychometric/function/sigmoid.h"

namespace haptrial::psychometric {

/// Parameters of a psychometric function, stated once for procedures, fits, observers and
/// predictions.
struct PsychometricParameters {
  Sigmoid sigmoid{Sigmoid::kLogistic};
  Axis axis{};            // x of a level
  double threshold{0.0};  // the level at which S is `share` [unit of the level]
  double width{1.0};      // w > 0, from S = tail to S = 1 - tail [unit of the axis]
  double guess{0.0};      // lower asymptote, 0 <= guess
  double lapse{0.0};      // 1 - upper asymptote, 0 <= lapse, guess + lapse < 1
  double share{0.5};      // S at the threshold, 0 < share < 1; Watson's Weibull has 1 - 1/e
  double tail{0.05};      // 0 < tail < 1/2; psignifit 4 has 0.05
  bool falling{false};    // S = 1 - F in place of F
};

/// Sigmoid and direction by a name of sigmoid_names(), and for a logarithmic one an axis of natural
/// logarithms, as psignifit has it. @throws std::invalid_argument with the names that are allowed
PsychometricParameters parameters_named(std::string_view name, double guess = 0.0);

/// Gives a function the sigmoid and the direction of a name, and its linear axis the scale
/// `logarithmic` if the name is that of a logarithmic sigmoid. The one way from a name to a
/// function, so that no reader of a name forgets the direction.
/// @throws std::invalid_argument as parameters_named()
void set_sigmoid(PsychometricParameters& parameters, std::string_view name, Scale logarithmic);

/// @throws std::invalid_argument naming share or tail if it breaks its bound.
SigmoidCurve curve_of(const PsychometricParameters& parameters);

/// Probability of answer 1 ("correct", "yes", "stronger") at a level:
///
///     psi(level) = guess + (1 - guess - lapse) S(x),   S as SigmoidCurve, x on the axis
///
/// Source: Schütt, Harmeling, Macke, Wichmann 2016, Vision Research 122, eqs. 1 to 3.
class PsychometricFunction {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit PsychometricFunction(const PsychometricParameters& parameters);
  /// The same for many functions of one curve, each with its threshold at x on the axis; the
  /// threshold of `parameters` is not read.
  /// @param curve  curve_of(parameters)
  PsychometricFunction(const PsychometricParameters& parameters, const SigmoidCurve& curve,
                       double x);

  double operator()(double level) const noexcept { return at(parameters_.axis.at(level)); }
  double at(double x) const noexcept;              // x on the axis
  double derivative(double level) const noexcept;  // d psi / d level [1/unit of the level]

  /// The level for a probability.
  /// @throws std::invalid_argument unless the probability lies between both asymptotes.
  double level_for(double probability) const;
  double x_for(double probability) const;  // the same on the axis
  /// The level at which S is `share`: free of guesses and lapses.
  /// @throws std::invalid_argument unless 0 < share < 1
  double level_for_share(double share) const;

  const PsychometricParameters& parameters() const noexcept { return parameters_; }

 private:
  double z_at(double x) const noexcept { return curve_.centre() + rate_ * (x - middle_); }
  double x_for_share(double share) const;

  PsychometricParameters parameters_;
  SigmoidCurve curve_;
  double middle_;  // m [axis]
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

}  // namespace haptrial::psychometric
