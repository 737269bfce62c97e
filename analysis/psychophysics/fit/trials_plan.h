#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/fitted_function.h"
#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychometric/models/detection.h"
#include "analysis/psychometric/models/diffusion.h"
#include "analysis/psychophysics/fit/cue_plan.h"
#include "analysis/psychophysics/fit/method_plans.h"
#include "analysis/psychophysics/fit/reaching_plan.h"
#include "analysis/statistics/design/analysis_plan.h"

namespace haptrial {

class Table;
}

namespace haptrial::analysis::trials {

/// Kind of analysis of the answers.
enum class AnalysisKind {
  kNone,            // trials, reaction times and quality alone
  kPsychometric,    // functions of the level: thresholds, slopes, Weber fractions
  kDetection,       // signal and noise: d', criterion, ROC of ratings
  kIdentification,  // one of several: confusions, share of right answers, d' of m alternatives
  kMagnitude,       // numbers in proportion to what was felt: exponents
  kAdjustment,      // levels that participants set: means
  kTimes,           // how soon answers or movements come, and how many are right
  kReaching,        // movements, which have an analysis of their own
  kPursuit,         // how the hand follows a target that moves
  kProduced,        // forces and movements that a stage's hand produces
  kPaired,          // which of two items was chosen: their worths
};

/// The factor whose levels are the sessions of a participant, by name or number.
inline constexpr const char* kSession = "session";

/// Levels by the name of their factor, as tables show them.
using StatedLevels = std::map<std::string, std::vector<std::string>>;

/// A variable whose levels procedures set.
struct ProcedureLevels {
  std::string variable;
  psychometric::Axis axis;    // of its procedures, with its unit
  std::optional<bool> falls;  // whether their answers 1 get rarer as the level rises
};

/// A question of the definition, as an analysis of its answers needs it.
struct PlanQuestion {
  std::string name;
  std::vector<std::string> choices;  // in their order, a silent one that is no alternative behind
  bool last_is_silent{false};        // it is given by silence alone, and two others can be chosen
  bool judged{false};                // the definition says which answer is right

  /// Answers that somebody who guesses may give; 0: numbers.
  std::size_t alternatives() const { return choices.size() - (last_is_silent ? 1 : 0); }
};

/// Values of the rest of a definition that stand in for keys that [analysis] does not have.
struct PlanDefaults {
  AnalysisKind kind{AnalysisKind::kNone};
  std::vector<std::string> factors;  // that [factors] varies, as written, and "group" of several
  std::vector<PlanQuestion> questions;
  std::vector<std::string> names;            // that `by` may name besides
  std::vector<ProcedureLevels> procedures;   // one for each variable
  std::vector<std::string> within_settings;  // factors that vary while a level is adjusted
  bool counts_formula{false};  // a procedure learns from a formula, not whether answers are right
  ReachingNames reaching;      // that the analysis of movements may name
  PursuitNames pursuit;        // that the analysis of pursuits may name
  ProducedNames produced;      // that the analysis of what is produced may name
  CueNames cues;               // that the comparison of cues may name
  std::vector<std::string> pages;     // whose scores may be the covariate
  StatedLevels levels;                // of names of `by`, where the definition states all of them
  std::vector<std::string> sessions;  // their names, in their order
};

/// The highest lapse rate, and guess rate without catch trials, unless stated: with lapses up to
/// 15 % intervals hold the truth (docs/algorithms/procedure-coverage.md).
inline constexpr double kMostLapses = 0.2;

/// Content of [analysis] in a definition.
struct TrialsPlan {
  AnalysisKind kind{AnalysisKind::kNone};
  std::vector<std::string> by;  // factors whose levels are told apart
  std::string baseline;  // session from which changes are compared in place of values; empty: none
  std::vector<std::string> sessions;  // their names, in their order
  AnalysisPlan plan;                  // tests that were planned
  std::string tests_of;               // the quantity that they are of, as in results.json; empty:
                                      // that of the sequential rule, else the first
  std::string question;               // whose answer counts; empty: the first
  std::string yes;            // the answer that counts 1; empty: what the procedure learnt, else
                              // the right one
  std::string level;          // variable for the level; empty: the one that the procedure set
  bool level_is_set{false};   // `level` is one that procedures set; trials in which another
                              // procedure set another one have none
  bool level_assumed{false};  // procedures set several variables, and `level` is the first
  std::string measured;       // measure of the stimulus, of magnitudes; empty: it is the level
  std::string rating;         // question with a number: how sure; empty: none
  std::string stimulus;       // factor that says what was presented, of an identification
  std::vector<std::string> choices;  // of the question, as PlanQuestion has them, likewise
  bool last_is_silent{false};        // likewise
  DiscriminationTask discrimination{DiscriminationTask::kForcedChoice};  // likewise
  bool task_assumed{false};   // the definition does not state the task
  bool metacognition{false};  // whether ratings give meta-d' and the M-ratio
  std::string stage;      // whose duration is the time, of times; empty: the answer's reaction time
  bool diffusion{false};  // whether the diffusion model is fitted to choices and times
  DiffusionOptions diffusion_options;
  bool functions{false};  // whether functions are fitted
  std::string function_name{"norm"};
  psychometric::PsychometricParameters function{.guess = 0.5};
  bool guess_free{false};
  bool guess_is_lapse{false};  // a lapse is as likely to be the one answer as the other
  RateBounds lapse{.high = kMostLapses};
  double threshold_at{0.75};        // share of answers 1 at the threshold, lapses aside
  std::optional<double> reference;  // standard stimulus, for Weber fractions [unit of the level]
  bool bayesian{true};
  bool population{true};        // the mixed model of all participants
  bool hierarchical{false};     // the Bayesian model of all participants and conditions
  bool track_intervals{true};   // of the procedures' own estimates
  bool serial{true};            // drift and repetition
  std::size_t resamples{1999};  // of each function
  std::size_t permutations{9999};
  std::uint64_t seed{1};
  std::optional<CuePlan> cues;  // two cues whose combination is compared with the best
  ReachingPlan reaching;        // where `kind` is kReaching
  PursuitPlan pursuit;          // where `kind` is kPursuit
  ProducedPlan produced;        // where `kind` is kProduced
  PairedPlan paired;            // where `kind` is kPaired; `by` then ends with kItem

  /// Choices of an identification that somebody who guesses may give.
  int alternatives() const { return static_cast<int>(choices.size()) - (last_is_silent ? 1 : 0); }
  bool uses_level() const {
    return functions || kind == AnalysisKind::kMagnitude || kind == AnalysisKind::kAdjustment ||
           kind == AnalysisKind::kDetection;
  }
  Task task() const {
    return guess_is_lapse ? Task::kEqualAsymptote : guess_free ? Task::kYesNo : Task::kForcedChoice;
  }
};

/// Reads the table [analysis], all of whose keys may be left out. Problems are noted.
///
/// Tests that were planned compare levels of the factors of `by`, or combinations joined by ", "; a
/// level that is not stated is a problem. A function must fall if the procedure's answers 1 get
/// rarer as the level rises, and does so if it is left out. Detection fits functions if it states
/// one.
TrialsPlan read_trials_plan(Table& root, const PlanDefaults& defaults);

/// A test as tables name its sides: "0.30" is the level 0.3.
PlannedTest with_short_numbers(PlannedTest test);

/// The words of `kind`.
const char* name_of(AnalysisKind kind);

}  // namespace haptrial::analysis::trials
