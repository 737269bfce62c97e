#include "analysis/force_training/study/quality_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

std::optional<Spread> spread_of(std::vector<double> values) {
  if (values.empty()) {
    return std::nullopt;
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return Spread{*quantile(values, 0.5), *low, *high};
}

/// The values that are known, of all scores.
template <class Get>
std::optional<Spread> spread_over(const std::vector<const TrialScore*>& scores, const Get& get) {
  std::vector<double> values;
  for (const TrialScore* score : scores) {
    if (const std::optional<double>& value = get(score->quality)) {
      values.push_back(*value);
    }
  }
  return spread_of(std::move(values));
}

ParticipantQuality quality_of(const std::vector<const TrialScore*>& scores) {
  ParticipantQuality p;
  p.subject = scores.front()->subject;
  p.trials = scores.size();
  for (const TrialScore* score : scores) {
    p.flagged += flags_of(score->quality).empty() ? 0 : 1;
  }
  using Q = TrialQuality;
  p.saturation = spread_over(scores, [](const Q& q) { return q.test.saturation; });
  p.training_saturation = spread_over(scores, [](const Q& q) { return q.training.saturation; });
  p.duration = spread_over(scores, [](const Q& q) { return q.test.duration; });
  p.lag = spread_over(scores, [](const Q& q) { return q.lag; });
  return p;
}

/// "oscillating 2, saturated 3", the commonest first.
std::string counted_flags(std::span<const TrialScore> scores, std::size_t& flagged) {
  std::map<std::string, std::size_t> counts;
  for (const TrialScore& score : scores) {
    const auto flags = flags_of(score.quality);
    flagged += flags.empty() ? 0 : 1;
    for (const TrialFlag& flag : flags) {
      ++counts[flag.name];
    }
  }
  std::vector<std::pair<std::string, std::size_t>> order(counts.begin(), counts.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, count] : order) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count);
  }
  return text;
}

void add_few_trials(std::vector<std::string>& alarms, std::span<const TrialScore> scores) {
  constexpr double kFew = 0.8;
  const auto participants = participant_quality(scores);
  std::vector<double> trials;
  for (const ParticipantQuality& p : participants) {
    trials.push_back(static_cast<double>(p.trials));
  }
  const double median = *quantile(trials, 0.5);
  for (const ParticipantQuality& p : participants) {
    if (static_cast<double>(p.trials) < kFew * median) {
      alarms.push_back(
          fmt::format("{} has {}; the median participant has {:g}. Means of so few are less "
                      "certain than the analysis takes them for.",
                      p.subject, counted(p.trials, "scored trial"), median));
    }
  }
}

}  // namespace

std::vector<TrialScore> judged_trials(std::span<const TrialScore> scores,
                                      std::span<const TrialScore> tests) {
  std::map<std::string, std::int32_t> first_training;
  for (const TrialScore& score : scores) {
    const auto [at, fresh] = first_training.emplace(score.subject, score.session);
    at->second = std::min(at->second, score.session);
  }
  std::vector<TrialScore> judged(scores.begin(), scores.end());
  std::ranges::copy_if(tests, std::back_inserter(judged), [&](const TrialScore& test) {
    const auto trained = first_training.find(test.subject);
    return trained != first_training.end() && test.session > trained->second;
  });
  std::ranges::stable_sort(judged, {}, &TrialScore::subject);
  return judged;
}

std::vector<ParticipantQuality> participant_quality(std::span<const TrialScore> scores) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<const TrialScore*>> by_subject;
  for (const TrialScore& score : scores) {
    auto& list = by_subject[score.subject];
    if (list.empty()) {
      order.push_back(score.subject);
    }
    list.push_back(&score);
  }
  std::vector<ParticipantQuality> result;
  for (const std::string& subject : order) {
    result.push_back(quality_of(by_subject[subject]));
  }
  return result;
}

std::vector<std::string> quality_alarms(std::span<const TrialScore> scores) {
  std::vector<std::string> alarms;
  if (scores.empty()) {
    return alarms;
  }
  std::size_t flagged = 0;
  const std::string names = counted_flags(scores, flagged);
  if (flagged > 0) {
    alarms.push_back(fmt::format(
        "{} of {} flagged for how {} recorded ({}). A flag excludes nothing: \"Quality "
        "of the trials\" in the report gives the numbers.",
        flagged, counted(scores.size(), "scored trial") + (flagged == 1 ? " is" : " are"),
        flagged == 1 ? "it was" : "they were", names));
  }
  add_few_trials(alarms, scores);
  return alarms;
}

}  // namespace haptrial::analysis
