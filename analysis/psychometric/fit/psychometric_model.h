#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/psychometric/fit/sigmoid.h"

namespace haptrial::analysis {

/// The answers to one level.
struct TrialBlock {
  double level{0.0};  // in the unit of the stimulus
  int correct{0};     // 0 <= correct <= total; in yes/no tasks: "yes"
  int total{0};       // > 0
};

/// What the lower asymptote is.
enum class Task {
  kYesNo,           // a parameter of its own
  kForcedChoice,    // 1 / alternatives
  kEqualAsymptote,  // the lapse rate
};

/// Parameters of psi(x) = guess + (1 - guess - lapse) S(x; threshold, width). A logarithmic shape
/// has threshold and width in natural logarithms of the level.
struct PsychometricParameters {
  double threshold{0.0};
  double width{1.0};  // > 0
  double lapse{0.0};  // in [0, 1) [1]
  double guess{0.0};  // in [0, 1) [1]
  double eta{0.0};    // overdispersion, in [0, 1): 0 is the binomial distribution [1]
};

/// A psychometric function with its parameters.
class PsychometricFunction {
 public:
  PsychometricFunction(const Sigmoid& sigmoid, const PsychometricParameters& parameters)
      : sigmoid_(sigmoid), parameters_(parameters) {}

  const PsychometricParameters& parameters() const noexcept { return parameters_; }
  /// P(correct) at a level.
  double at(double level) const noexcept;
  /// The level with P(correct) = probability; nothing outside of (guess, 1 - lapse).
  std::optional<double> level_at(double probability) const noexcept;
  /// The level of S = threshold_share.
  double threshold_level() const noexcept { return sigmoid_.level(parameters_.threshold); }
  /// The level at which S has this share, inside (0, 1): free of guesses and lapses.
  double level_of_share(double share) const noexcept;
  /// d P(correct) / d level at a level [1/unit of the stimulus].
  double slope(double level) const noexcept;

 private:
  Sigmoid sigmoid_;
  PsychometricParameters parameters_;
};

/// Blocks of the same level as one, in the order of the levels.
/// @throws std::invalid_argument naming what breaks its bound, or "blocks" when there are none.
std::vector<TrialBlock> pooled(std::span<const TrialBlock> blocks);

/// Levels as the sigmoid takes them. @throws std::invalid_argument when one does not exist.
std::vector<double> coordinates(const Sigmoid& sigmoid, std::span<const TrialBlock> blocks);

/// 2 (log-likelihood of the shares themselves - that of the function), binomial, with its part of
/// each block as a residual with the sign of (observed - predicted).
struct PsychometricDeviance {
  double deviance{0.0};
  std::vector<double> residuals;  // sum of squares: deviance
};
PsychometricDeviance deviance_of(const PsychometricFunction& function,
                                 std::span<const TrialBlock> blocks);

}  // namespace haptrial::analysis
