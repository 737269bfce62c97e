#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/quality/trial_quality.h"

namespace haptrial::analysis {

/// A force curve sampled at a fixed rate from its first instant on.
struct ForceCurve {
  double rate{1000.0};        // [Hz]
  std::vector<double> force;  // (samples) [N]
};

/// The recall of one test pass against its target.
/// Source: Morris 2006, §4.3.
struct TrialScore {
  std::string subject;
  std::string condition;  // training condition of the block
  std::int32_t trial{0};
  std::int32_t block{0};  // in a study: over the sessions that train, as they follow each other
  std::int32_t repetition{0};
  double score{0.0};           // weighted average of the three below; 0 is perfect recall
  double alignment_cost{0.0};  // minimum path cost per path step, in the units of the error matrix
  double rms_force{0.0};       // after warping [N]
  double rms_slope{0.0};       // after warping [N/s]
  double rms_unaligned{0.0};   // plain RMS difference before any alignment [N]

  /// The level of each of StudyResult::factors, in their order; `condition` is the levels joined by
  /// ", ". Without several factors one level: the condition.
  std::vector<std::string> levels{};

  TrialQuality quality{};  // how it was recorded

  // Errors of the path, if an expert showed a path that was recalled without guidance; root mean
  // squares over the run of distances in the plane at equal times.
  std::optional<double> path_error{};  // of the recall from the path [m]
  std::optional<double> kept{};        // of the led hand from the expert's, in training [m]

  std::int32_t session{1};  // of the participant, from 1
};

}  // namespace haptrial::analysis
