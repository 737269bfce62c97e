#include "analysis/psychophysics/study/unused_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/psychophysics/fit/series.h"
#include "analysis/psychophysics/fit/surface_study.h"

namespace haptrial::analysis::trials {
namespace {

const std::string kUnanswered = "they have no answer";
const std::string kUnjudged =
    "nothing says which answer counts 1; [analysis] can name it (yes = \"ANSWER\")";
const std::string kNoLevel = "their level is not known";

std::string no_outcome(const StudyTrial& trial, const TrialsPlan& plan) {
  return outcome_of(trial, plan) >= 0                 ? std::string()
         : answer_to(trial, plan.question) == nullptr ? kUnanswered
                                                      : kUnjudged;
}

std::string no_point(const StudyTrial& trial, const TrialsPlan& plan) {
  const bool other = plan.level.empty() && has_surface(trial);
  if (other || !trial.probe.empty() || sets_other_level(trial, plan)) {
    return {};
  }
  const std::string why = no_outcome(trial, plan);
  return why.empty() && !std::isfinite(level_of(trial, plan)) ? kNoLevel : why;
}

std::string no_pair(const TrialsData& data, const StudyTrial& trial, const TrialsPlan& plan) {
  const std::string first = factor_level(data, trial, plan.paired.first);
  const std::string second = factor_level(data, trial, plan.paired.second);
  return first.empty() || second.empty() ? "an item is not known"
         : first == second               ? "both items are the same"
                                         : no_outcome(trial, plan);
}

std::string no_signal(const StudyTrial& trial, const TrialsPlan& plan) {
  return answer_to(trial, plan.question) == nullptr ? kUnanswered
         : signal_in(trial, plan, 0) < 0            ? "nothing says whether there was a signal"
                                                    : std::string();
}

std::string no_identity(const TrialsData& data, const StudyTrial& trial, const TrialsPlan& plan) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  if (answer == nullptr) {
    return kUnanswered;
  }
  return factor_level(data, trial, plan.stimulus).empty() ? plan.stimulus + " is not known"
         : answer->correct < 0                            ? "nothing says which answer is right"
         : std::find(plan.choices.begin(), plan.choices.end(), answer->text) == plan.choices.end()
             ? "their answer is none of the choices"
             : std::string();
}

std::string no_time(const StudyTrial& trial, const TrialsPlan& plan) {
  if (!plan.stage.empty()) {
    const StageTime* last = last_stage(trial, plan.stage);
    return last != nullptr && last->reached
               ? std::string()
               : fmt::format("the end of {} was not reached", plan.stage);
  }
  const GivenAnswer* answer = answer_to(trial, plan.question);
  return answer == nullptr                       ? kUnanswered
         : !std::isfinite(answer->reaction_time) ? "their answer has no time"
                                                 : std::string();
}

std::string no_number(const StudyTrial& trial, const TrialsPlan& plan) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  return !trial.probe.empty()                                 ? std::string()
         : answer == nullptr || !std::isfinite(answer->value) ? "they have no number"
         : !std::isfinite(level_of(trial, plan))              ? kNoLevel
                                                              : std::string();
}

/// Empty: the trial is used, or left out by a rule.
std::string unused_because(const TrialsData& data, const StudyTrial& trial,
                           const TrialsPlan& plan) {
  switch (plan.kind) {
    case AnalysisKind::kPsychometric:
      return no_point(trial, plan);
    case AnalysisKind::kPaired:
      return no_pair(data, trial, plan);
    case AnalysisKind::kDetection:
      return no_signal(trial, plan);
    case AnalysisKind::kIdentification:
      return no_identity(data, trial, plan);
    case AnalysisKind::kTimes:
      return no_time(trial, plan);
    case AnalysisKind::kMagnitude:
      return no_number(trial, plan);
    default:
      return {};
  }
}

}  // namespace

std::vector<UnusedTrials> unused_trials(const TrialsData& data, const TrialsPlan& plan) {
  std::map<std::string, std::size_t> counts;
  for (const StudyTrial& trial : data.trials) {
    if (trial.counts()) {
      ++counts[unused_because(data, trial, plan)];
    }
  }
  counts.erase("");
  std::vector<UnusedTrials> all;
  for (const auto& [because, count] : counts) {
    all.push_back({because, count});
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &UnusedTrials::count);
  return all;
}

}  // namespace haptrial::analysis::trials
