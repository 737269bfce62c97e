#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/trial_blocks.h"
#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::analysis::trials {

/// A trial as a psychometric function takes it.
struct LevelTrial {
  std::size_t trial{0};  // in TrialsData::trials
  double level{0.0};     // presented [unit of the variable]
  double asked{0.0};
  int outcome{0};  // 1 or 0
  int choice{0};   // of two answers +1 or -1; 0: not known
  int side{0};     // the choice whose outcome would be 1, likewise
  Word track;      // empty: none
};

/// The trials of one participant in one combination of factors, in their order.
struct AnsweredSeries {
  std::string participant;
  std::vector<std::string> levels;  // of each factor of TrialsPlan::by
  std::vector<LevelTrial> trials;
  bool adaptive{false};                           // levels depended on the answers
  std::optional<psychometric::LevelRange> range;  // of what could be presented, if adaptive
  TrialBlock catches{kNoStimulus};  // trials without a stimulus, if a guess rate is sought

  std::string condition() const;  // levels joined by ", "; empty: there are no factors
};

/// Whether a procedure set another variable in the trial than the one that is the plan's level.
bool sets_other_level(const StudyTrial& trial, const TrialsPlan& plan);
/// The level that a trial presented; NaN: it has none.
double level_of(const StudyTrial& trial, const TrialsPlan& plan);
/// 1 or 0 as the plan counts answers; -1: not known.
int outcome_of(const StudyTrial& trial, const TrialsPlan& plan);
/// 1 where "yes" is right, 0 where "no" is, -1 if that is not known. If the definition does not say
/// what is right, a level above 0 without a probe is a signal; noise is a probe (a catch trial) or
/// the level 0. @param outcome  1: the answer was "yes"
int signal_in(const StudyTrial& trial, const TrialsPlan& plan, int outcome);
/// The answer that counts as "yes".
std::string yes_of(const TrialsPlan& plan);
/// The levels of the plan's factors in a trial.
std::vector<std::string> factors_of(const TrialsData& data, const StudyTrial& trial,
                                    const TrialsPlan& plan);

/// Trials that count and have a level of one dimension and an outcome (of a level with several
/// dimensions the one that the plan names; without a name see surface_study.h), ordered by
/// participant and first occurrence of the combination. Trials of all sessions of a participant
/// stand together. If a guess rate is sought, their catch trials (probes without a level in which
/// "no" is right) stand beside them.
std::vector<AnsweredSeries> series_of(const TrialsData& data, const TrialsPlan& plan);

/// Answers by level. Levels that agree in nine digits are one, since the arithmetic of a procedure
/// reaches a level from above and below. Catch trials come first.
std::vector<TrialBlock> blocks_of(const AnsweredSeries& series);

}  // namespace haptrial::analysis::trials
