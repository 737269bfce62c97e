#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/models/cue_combination.h"
#include "analysis/psychophysics/fit/function_fit.h"

namespace haptrial::analysis::trials {

/// One participant at one level of CuePlan::at. Standard deviations are those of the fitted
/// functions, on the axis: from a share of 1/2 to a share of Phi(1), lapses aside.
struct CuePerson {
  std::string participant;
  Estimated first_sd, second_sd;  // of one cue alone
  Estimated both_sd;              // geometric mean over conflicts
  Estimated predicted_sd;         // that somebody who combines best would show (cue_bias.h)
  Estimated weight;               // of the first cue, from the levels of equality of the conflicts
  Estimated predicted_weight;
  double bias{0.0};          // of all conflicts alike [unit of the axis]
  std::size_t conflicts{0};  // from which the weight comes
};

/// A test over participants, and its p adjusted over the levels by Holm's method.
struct CueTest {
  Defined<TTest> test{Undefined{"nobody has all conditions"}};
  Defined<double> holm{Undefined{"nobody has all conditions"}};
};

/// The participants at one level of CuePlan::at.
struct CueLevel {
  std::string level;  // empty: there is one reliability
  std::vector<CuePerson> people;
  std::vector<std::string> left_out;  // who and why, a sentence each without its full stop
  CueTest weight;                     // observed - predicted, two-sided
  CueTest log_sd;                     // log observed - log predicted, two-sided
  CueTest beats_best;                 // log observed < log of the better single cue, one-sided
};

/// Observed against predicted combination of two cues (analysis/psychometric/models).
struct CueStudy {
  std::vector<CueLevel> levels;  // in the order of their numbers or words
};

/// Compares what the functions of both cues tell with what those of one cue predict. Intervals of a
/// participant come from the bootstrap of the functions; without one there are none, and conflicts
/// are weighed alike. The second cue, if it was measured at one level of `at`, counts for all.
/// @param series, fits  of the same conditions in the same order
/// @param plan          with `cues`
CueStudy cue_study(const TrialsData& data, const std::vector<AnsweredSeries>& series,
                   const std::vector<FunctionFit>& fits, const TrialsPlan& plan);

/// Mean of a number over participants with its interval of 95 % (Student's t); no interval for one
/// participant, nothing known for none. @param geometric  of standard deviations
Estimated mean_of(const CueLevel& level, Estimated CuePerson::*number, bool geometric);

}  // namespace haptrial::analysis::trials
