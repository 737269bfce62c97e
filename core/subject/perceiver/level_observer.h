#pragma once

#include <cstdint>
#include <span>

#include "core/psychometric/function/psychometric_function.h"
#include "core/subject/perceiver/felt.h"
#include "core/subject/perceiver/judgement.h"

namespace haptrial::subject {

/// How the hand explores, in as far as the felt noise depends on it.
struct Exploration {
  double press{3.0};  // force with which springs are pressed > 0 [N]
  double depth{0.0};  // or depth to which they are pushed; 0: pressed with `press` >= 0 [m]
  double speed{0.1};  // mean speed at which a viscosity is felt > 0 [m/s]
};

/// A perceiver at the level of responses: the same senses and the same judge (felt.h, judgement.h)
/// without a hand, for levels in place of what the hand met. LevelsTest holds it against the hand.
class LevelObserver {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  LevelObserver(const SenseParameters& senses, Quantity quantity, const Exploration& exploration,
                const JudgementParameters& judgement, std::uint64_t session_seed);

  /// Contacts that the hand would have at a level.
  ContactEpisode met(double level) const noexcept;
  /// How a level is felt in an interval with this noise.
  double percept(double level, const FeltNoise& noise) const noexcept;

  /// Whole trials, with the streams "sense <trial>" and "judgement <trial>". Levels are those of
  /// the intervals in their order. Each takes the answer before from the last call.
  Decision between(int trial, std::span<const double> levels, Extreme extreme) noexcept;
  Decision yes_no(int trial, double level) noexcept;

  /// sd of the log of a percept, the Weber fraction of one interval; the floor of forces to first
  /// order. Scaled so that the log of the level changes the log of the percept by 1.
  double weber(double level) const noexcept;

  /// Probability that a comparison is felt as more than a reference, on a log10 axis: a cumulative
  /// Gaussian about the reference with both noises at the reference, lapses on either side. Without
  /// bias, repetition and drift; the judge is logarithmic.
  psychometric::PsychometricParameters discrimination(double reference) const;

 private:
  SenseParameters senses_;
  Quantity quantity_;
  Exploration exploration_;
  JudgementParameters judgement_;
  std::uint64_t seed_;
  Judge judge_;
};

}  // namespace haptrial::subject
