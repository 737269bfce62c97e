#pragma once

#include <cstdint>
#include <span>

#include "core/base/random.h"

namespace haptrial::subject {

/// How somebody decides. Evidence is the natural logarithm of a percept, or the percept itself.
struct JudgementParameters {
  bool logarithmic{true};
  double noise{0.0};            // sd of the evidence of each interval, beside the sense >= 0
  double bias_first{0.0};       // added to the evidence of the first interval
  double repetition{0.0};       // added to the evidence of the answer before, taken off the others
  double criterion{1.0};        // of a yes [unit of the percept]; above 0 if logarithmic
  double drift{0.0};            // of the criterion a trial [evidence]
  double lapse{0.0};            // probability of an answer at random, 0 to 1
  double exponent{1.0};         // of magnitudes > 0
  double modulus{1.0};          // magnitude of a percept of 1 > 0
  double magnitude_noise{0.0};  // sd of the log of a magnitude >= 0
  double tolerance{0.05};       // of an adjustment >= 0 [evidence]
};

/// An answer and how clear it was.
struct Decision {
  int answer{0};         // from 0: which interval; 1 for yes
  double evidence{0.0};  // of this answer over the next best >= 0; 0 for a lapse
  bool lapsed{false};
};

enum class Extreme { kLargest, kSmallest };

/// Decides from percepts. Each trial draws from its own stream, so that its noise does not depend
/// on the trials before; what does depend on them, the answer before, is told.
///
///     judge.begin_trial(17);
///     judge.set_previous(answer_16);     // as it was recorded
///     judge.between(percepts, Extreme::kLargest).answer;
///
/// Servo thread after construction: no allocation, lock, I/O or throw.
class Judge {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  Judge(const JudgementParameters& parameters, std::uint64_t session_seed);

  /// @param trial  from 0; names the stream and sets the drift
  void begin_trial(int trial) noexcept;
  /// @param answer  to the same question in the trial before; below 0 there is none
  void set_previous(int answer) noexcept { previous_ = answer; }

  /// Which interval has the largest or smallest percept. Percepts that are alike to the bit, such
  /// as two of nothing, are answered at random. @param percepts  at most 16
  Decision between(std::span<const double> percepts, Extreme extreme) noexcept;
  /// Whether the percept is above the criterion.
  Decision yes_no(double percept) noexcept;
  /// Which of several prototypes the percept is nearest to; the evidence is how far it lies from
  /// where the next best would be as near. @param prototypes  percepts, at most 16
  Decision nearest(double percept, std::span<const double> prototypes) noexcept;

  /// Number of a percept: modulus · percept^exponent with log-normal noise.
  double magnitude(double percept) noexcept;
  /// The same if `standard` was called `number`, with the standard's own percept.
  double magnitude(double percept, double standard, double number) noexcept;

  /// +1 if `percept` should be more to equal `wanted`, -1 less, 0 if it is within the tolerance.
  int adjust(double percept, double wanted) noexcept;

 private:
  double evidence(double percept) const noexcept;
  Decision lapse(int answers) noexcept;

  JudgementParameters parameters_;
  std::uint64_t seed_;
  RandomStream random_;
  int trial_{0};
  int previous_{-1};
};

/// Confidence from 1 to `categories`: equal parts of the probability to be right, from chance to
/// certainty, 2 Phi(evidence / noise) - 1 (confidence as in signal detection theory).
/// @param noise  sd of the evidence between two intervals, or of one; @param categories  at least 1
int confidence(const Decision& decision, double noise, int categories) noexcept;

}  // namespace haptrial::subject
