#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychophysics/fit/function_fit.h"
#include "analysis/psychophysics/fit/serial_regression.h"
#include "analysis/psychophysics/fit/track_estimate.h"
#include "analysis/statistics/tests/t_tests.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::analysis::trials {

/// Effects in a participant's trials beside the level: change over the session, and dependence on
/// the answer before.
struct SerialEffects {
  std::string participant;
  std::size_t trials{0};
  SerialCoefficients by_chance{0.0, 0.0};  // of somebody without effects; 0: levels were given
  SerialCoefficients effects;              // less those by chance
  std::size_t easy{0};                     // trials at levels where S > 0.99
  std::size_t easy_wrong{0};               // of them with answer 0
  std::size_t limited{0};                  // trials whose level is not the one that was asked for
};

/// The regressions of serial_coefficients() beside the fitted function of each series. Where levels
/// followed from answers, less what serial_coefficients_by_chance() says of the participant; not
/// defined where that cannot be said, because no function of what the procedure learnt from is
/// fitted. Practice and trials without a function do not take part. Without two choices the outcome
/// counts as the choice, and the side is 1.
/// @param tracks  of track_estimates()
std::vector<SerialEffects> serial_effects(const TrialsData& data,
                                          const std::vector<AnsweredSeries>& series,
                                          const std::vector<FunctionFit>& fits,
                                          const std::vector<TrackEstimate>& tracks,
                                          const TrialsPlan& plan, const ProcedureOf& procedure_of,
                                          int threads);

/// The mean over participants against 0. Undefined as paired_t_test.
Defined<TTest> against_zero(const std::vector<double>& values);

/// Values of those participants who have them.
std::vector<double> drifts(const std::vector<SerialEffects>& effects);
std::vector<double> repetitions(const std::vector<SerialEffects>& effects);

/// A track whose procedure chose its levels by the answers, and how to begin it anew.
struct SerialTrack {
  bool finished{true};  // else it was broken off
  std::function<std::unique_ptr<psychometric::Procedure>()> begin;
};

/// A participant's sessions as they went.
struct SerialRecord {
  std::vector<SerialTrial> trials;
  std::vector<int> tracks;  // of each trial, in `adaptive`; -1: its level did not depend on answers
  std::vector<SerialTrack> adaptive;
  SerialFunctions functions;
};

/// Average coefficients of somebody who has these functions, does not drift and does not repeat
/// answers: levels that follow from the answers before pull them from 0. Their tracks are done
/// anew, in the recorded order, their functions are fitted anew.
/// @param seed  of the answers
/// @returns means of those of 25 sessions that have coefficients; not defined of fewer than eight
SerialCoefficients serial_coefficients_by_chance(const SerialRecord& record,
                                                 const LikelihoodOptions& options,
                                                 std::uint64_t seed);

}  // namespace haptrial::analysis::trials
