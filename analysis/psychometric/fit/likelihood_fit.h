#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "analysis/psychometric/fit/fitted_function.h"
#include "analysis/psychometric/fit/prior.h"
#include "analysis/psychometric/fit/trial_blocks.h"

namespace haptrial::analysis {

namespace climbing {
struct Climb;
using Place = std::array<double, 4>;  // threshold, log width, lapse, guess
}  // namespace climbing

/// A rate above it would be no rate of lapses or guesses.
inline constexpr double kLargestRate = 0.5;

/// Bounds from low to high; equal if the value is known.
struct RateBounds {
  double low{0.0};
  double high{0.06};  // Wichmann and Hill 2001
};

struct SearchBounds {
  double low{0.0};
  double high{0.0};
};

struct LikelihoodOptions {
  // Sigmoid, axis, share, tail and direction; the guess rate of a forced choice. The rest is
  // sought.
  psychometric::PsychometricParameters function{.guess = 0.5};
  Task task{Task::kForcedChoice};
  RateBounds lapse{};  // 0 <= low <= high <= 0.5
  RateBounds guess{};  // of a yes/no task, likewise
  // The range that could be presented, on the axis, if it is more than the levels of the trials.
  std::optional<SearchBounds> presentable{};
};

struct LikelihoodFit {
  FittedParameters parameters;  // eta is 0
  double log_likelihood{0.0};   // without binomial coefficients
  int steps{0};
  /// Whether the slope of the likelihood along every parameter inside its bounds is 0.
  bool converged{false};
  /// Threshold or width ended at its bound, or its standard error is at least s or a factor 20: the
  /// answers do not tell it, for example because all of them change at one level, or none.
  bool undetermined{false};
};

/// A parameter that is held while the others are fitted, and how its value is stated.
enum class Held {
  kThreshold,  // on the axis
  kWidth,      // as its natural logarithm
};

/// A point of a profile likelihood.
struct HeldFit {
  FittedParameters parameters;
  double log_likelihood{0.0};
  double slope{0.0};  // of the profile: d log-likelihood / d value
};

/// Fits by maximum likelihood to answers at given levels: Newton's method on threshold, log width,
/// lapse and guess rate within bounds, Fisher's information where the likelihood is not concave.
/// The threshold keeps within s = high - low of the levels, the width between their smallest
/// distance and 20 s: a likelihood may have no maximum, and answers do not tell steps apart that
/// are steeper than the levels are close.
/// Source: Wichmann and Hill 2001, Perception & Psychophysics 63, 1293.
class LikelihoodFitter {
 public:
  /// @param blocks  whose levels and totals are taken; two different levels.
  /// @throws std::invalid_argument naming the option or the part of a block that breaks its bound.
  LikelihoodFitter(const LikelihoodOptions& options, std::span<const TrialBlock> blocks);

  /// @param correct  answers of each block, as many as there are blocks.
  /// No allocation, so that simulations can call it in any number.
  LikelihoodFit fit(std::span<const int> correct) const noexcept;
  /// The same without one trial: of block `block`, a correct one or a wrong one.
  LikelihoodFit fit_without(std::span<const int> correct, std::size_t block,
                            bool right) const noexcept;
  /// The same from a place of one's own: answers to single trials may have several maxima.
  LikelihoodFit fit_from(std::span<const int> correct, const FittedParameters& from) const noexcept;
  /// The fit with one parameter held at a value within its bounds. @param from  where to begin
  HeldFit fit_holding(std::span<const int> correct, Held held, double value,
                      const FittedParameters& from) const noexcept;
  SearchBounds bounds(Held held) const noexcept;

  /// The function of a fit. @throws std::invalid_argument naming what breaks its bound.
  psychometric::PsychometricFunction function(const FittedParameters& fitted) const {
    return fitted_function(shape_, curve_, fitted);
  }
  int trials() const noexcept;  // in all blocks
  /// Parameters that are neither known nor tied to another.
  int free_parameters() const noexcept;

 private:
  struct Search;
  LikelihoodFit search(const Search& search, climbing::Place place,
                       climbing::Climb& climb) const noexcept;

  psychometric::PsychometricParameters shape_;
  psychometric::SigmoidCurve curve_;
  Task task_;
  RateBounds lapse_, guess_;
  std::vector<double> coordinates_;
  std::vector<int> totals_;
  double low_{0.0}, high_{0.0}, spacing_{0.0};
};

/// The levels with what could be presented; the smallest distance is that of the levels.
/// @throws std::invalid_argument when there are not two different levels.
StimulusRange range_of(const LikelihoodOptions& options, std::span<const double> coordinates);

/// One fit. @throws std::invalid_argument as the constructor.
LikelihoodFit likelihood_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options);

}  // namespace haptrial::analysis
