#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/random.h"
#include "core/psychometric/function/psychometric_function.h"

namespace haptrial::psychometric {

struct ObserverParameters {
  PsychometricParameters function;  // lapses and guesses are part of it
  double repetition{0.0};           // pull towards the answer before [unit of the axis]
  double drift{0.0};                // of the threshold [unit of the axis a trial]
};

/// A virtual participant at the level of responses: answers 1 with the probability
///
///     psi at x + repetition s - drift n
///
/// with s = +1 after an answer 1, -1 after an answer 0 and 0 before the first, and n the number of
/// trials so far. If the function falls, the pull changes its sign, so that a positive repetition
/// always repeats.
class ResponseObserver {
 public:
  /// @param seed, name  of the random stream
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  ResponseObserver(const ObserverParameters& parameters, std::uint64_t seed, std::string_view name);

  /// Probability of answer 1 on the next trial.
  double probability(double level) const noexcept;
  /// 0 or 1; one more trial is done.
  int answer(double level) noexcept;

 private:
  PsychometricFunction function_;
  double repetition_;
  double drift_;
  RandomStream random_;
  int before_{0};  // +1, -1 or 0
  std::int64_t trials_{0};
};

}  // namespace haptrial::psychometric
