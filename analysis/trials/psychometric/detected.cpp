#include "analysis/trials/psychometric/detected.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <utility>

#include "analysis/trials/psychometric/series.h"

namespace haptrial::analysis::trials {
namespace {

using Key = std::pair<std::string, std::vector<std::string>>;

struct Collected {
  DetectionCounts counts;
  std::map<double, std::pair<int, int>> ratings;  // value -> noise, signal
};

/// How sure, above 0 for "yes"; NaN: not rated.
double rating_of(const StudyTrial& trial, const TrialsPlan& plan, int outcome) {
  const GivenAnswer* rating = plan.rating.empty() ? nullptr : answer_to(trial, plan.rating);
  if (rating == nullptr || !std::isfinite(rating->value)) {
    return kNotKnown;
  }
  return outcome == 1 ? rating->value : -rating->value;
}

/// 1 signal, 0 noise, -1 neither.
int signal_in(const StudyTrial& trial, const TrialsPlan& plan, int outcome) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  if (answer != nullptr && answer->correct >= 0) {
    return answer->correct == 1 ? outcome : 1 - outcome;
  }
  if (!trial.probe.empty()) {
    return 0;
  }
  const double level = level_of(trial, plan);
  return std::isfinite(level) ? (level > 0.0 ? 1 : 0) : -1;
}

void add(Collected& collected, int signal, int outcome, double rating) {
  DetectionCounts& c = collected.counts;
  double& count = signal == 1 ? (outcome == 1 ? c.hits : c.misses)
                              : (outcome == 1 ? c.false_alarms : c.correct_rejections);
  count += 1.0;
  if (std::isfinite(rating)) {
    auto& both = collected.ratings[rating];
    (signal == 1 ? both.second : both.first) += 1;
  }
}

}  // namespace

std::vector<DetectedCondition> detected(const TrialsData& data, const TrialsPlan& plan) {
  std::map<Key, Collected> all;
  for (const StudyTrial& trial : data.trials) {
    const GivenAnswer* answer = answer_to(trial, plan.question);
    if (!trial.counts() || answer == nullptr) {
      continue;
    }
    const int outcome = answer->text == (plan.yes.empty() ? "yes" : plan.yes) ? 1 : 0;
    const int signal = signal_in(trial, plan, outcome);
    if (signal >= 0) {
      add(all[{data.session_of(trial).participant, factors_of(data, trial, plan)}], signal, outcome,
          rating_of(trial, plan, outcome));
    }
  }
  std::vector<DetectedCondition> result;
  for (const auto& [key, collected] : all) {
    DetectedCondition one;
    one.participant = key.first;
    one.levels = key.second;
    one.condition = fmt::format("{}", fmt::join(one.levels, ", "));
    one.counts = collected.counts;
    one.detection = detection(one.counts, RateCorrection::kLogLinear);
    for (const auto& [value, counts] : collected.ratings) {
      one.ratings.noise.push_back(counts.first);
      one.ratings.signal.push_back(counts.second);
    }
    if (one.ratings.noise.size() > 1) {
      one.roc = rating_roc(one.ratings);
      one.binormal = binormal_roc(one.ratings);
    }
    result.push_back(std::move(one));
  }
  return result;
}

}  // namespace haptrial::analysis::trials
