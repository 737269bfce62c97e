#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// The middle and the ends of a quantity over a participant's scored trials.
struct Spread {
  double median{0.0};
  double low{0.0};
  double high{0.0};
};

struct ParticipantQuality {
  std::string subject;
  std::size_t trials{0};  // scored
  std::size_t flagged{0};
  std::optional<Spread> saturation;           // shares
  std::optional<Spread> training_saturation;  // shares
  std::optional<Spread> duration;             // [s]
  std::optional<Spread> lag;                  // [s]
};

/// The trials whose quality is judged: those of sessions that train, and of tests that came after a
/// training of the participant. Before a training nobody knows what to press.
std::vector<TrialScore> judged_trials(std::span<const TrialScore> scores,
                                      std::span<const TrialScore> tests);

/// Quality by subject, in the order of the scores. Quantities are empty if no trial has them.
std::vector<ParticipantQuality> participant_quality(std::span<const TrialScore> scores);

/// Sentences that nobody may overlook: how many trials are flagged and with what, and participants
/// with fewer than four fifths of the scored trials that the median participant has. None where all
/// is in order.
std::vector<std::string> quality_alarms(std::span<const TrialScore> scores);

}  // namespace haptrial::analysis
