#pragma once

#include <cstdint>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"

namespace haptrial::test {

/// Use of two cues by simulated people.
enum class CueUse {
  kLeastVariance,  // both, weighed by 1 / variance
  kBetterAlone,    // the one with the smaller standard deviation
};

/// A study of size by eye and by hand at the level of answers: constant stimuli about 55 mm, the
/// cues of the standard 6 mm apart at most.
struct SimulatedCues {
  int participants{8};
  CueUse use{CueUse::kLeastVariance};
  std::vector<double> eye_sd{0.0042};  // at each noise, 0, 1, ... [m]
  double hand_sd{0.0055};              // [m]
  double spread{0.15};                 // of log standard deviations between participants
  double lapse{0.01};
  int repetitions{12};  // of each of seven levels
  bool exact{false};    // shares of answers are the probabilities, as near as counts can be
  std::uint64_t seed{1};
};

/// The standard deviations and the weight of the eye that somebody has.
struct TrueCues {
  double eye{0.0}, hand{0.0}, both{0.0};
  double weight{0.0};
};

/// @param participant  from 0
TrueCues true_cues(const SimulatedCues& study, int participant, std::size_t noise);

analysis::trials::TrialsData simulated_cues(const SimulatedCues& study);

/// The plan that such a study's definition would state; without a bootstrap.
analysis::trials::TrialsPlan plan_of(const SimulatedCues& study);

}  // namespace haptrial::test
