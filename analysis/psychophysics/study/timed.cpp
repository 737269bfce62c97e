#include "analysis/psychophysics/study/timed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis::trials {
namespace {

/// Duration of a stage in the last interval that has it [s]; NaN: its end was not reached.
double duration_of(const StudyTrial& trial, const std::string& stage, double rate) {
  const StageTime* last = last_stage(trial, stage);
  return last != nullptr && last->reached ? static_cast<double>(last->ticks) / rate : kNotKnown;
}

double time_of(const TrialsData& data, const StudyTrial& trial, const GivenAnswer* answer,
               const TrialsPlan& plan) {
  if (!plan.stage.empty()) {
    return duration_of(trial, plan.stage, data.session_of(trial).rate);
  }
  return answer == nullptr ? kNotKnown : answer->reaction_time;
}

void add_trial(TimedCondition& one, const TrialsData& data, const StudyTrial& trial,
               const TrialsPlan& plan) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  const int correct = answer == nullptr ? -1 : answer->correct;
  ++one.trials;
  one.judged += correct >= 0 ? 1 : 0;
  one.wrong += correct == 0 ? 1 : 0;
  const double time = time_of(data, trial, answer, plan);
  const int outcome = outcome_of(trial, plan);
  if (plan.diffusion && outcome >= 0 && std::isfinite(time)) {
    one.choices.push_back({outcome == 1, time});
  }
  if (correct != 0 && std::isfinite(time)) {
    one.times.push_back(time);
    one.times_at.push_back(plan.level.empty() ? kNotKnown : level_of(trial, plan));
  }
}

Defined<Regression> line_of(const TimedCondition& one) {
  std::vector<double> levels, times;
  for (std::size_t i = 0; i < one.times.size(); ++i) {
    if (std::isfinite(one.times_at[i])) {
      levels.push_back(one.times_at[i]);
      times.push_back(one.times[i]);
    }
  }
  return linear_regression(levels, times);
}

}  // namespace

std::vector<TimedCondition> timed(const TrialsData& data, const TrialsPlan& plan) {
  std::map<std::pair<std::string, std::vector<std::string>>, TimedCondition> all;
  for (const StudyTrial& trial : data.trials) {
    if (trial.counts()) {
      add_trial(all[{data.session_of(trial).participant, factors_of(data, trial, plan)}], data,
                trial, plan);
    }
  }
  std::vector<TimedCondition> result;
  for (auto& [key, one] : all) {
    one.participant = key.first;
    one.levels = key.second;
    one.condition = fmt::format("{}", fmt::join(one.levels, ", "));
    if (!one.times.empty()) {
      one.mean = std::accumulate(one.times.begin(), one.times.end(), 0.0) /
                 static_cast<double>(one.times.size());
      one.median = quantile(one.times, 0.5);
    }
    if (plan.diffusion) {
      one.diffusion = fit_diffusion(one.choices, plan.diffusion_options);
    }
    if (!plan.level.empty()) {
      one.line = line_of(one);
    }
    result.push_back(std::move(one));
  }
  return result;
}

std::string slope_unit(const TrialsPlan& plan) { return "s per " + plan.level; }

}  // namespace haptrial::analysis::trials
