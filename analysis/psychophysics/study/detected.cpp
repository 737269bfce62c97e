#include "analysis/psychophysics/study/detected.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "analysis/psychometric/models/information_transfer.h"
#include "analysis/psychophysics/fit/series.h"

namespace haptrial::analysis::trials {
namespace {

using Key = std::pair<std::string, std::vector<std::string>>;

/// Ratings by answer and how sure it was, the surest "no" first.
struct AnswerRatings {
  std::map<std::pair<int, double>, std::pair<int, int>> given;  // -> of noise, of signal

  void add(int signal, int outcome, double sureness) {
    auto& both = given[{outcome, outcome == 1 ? sureness : -sureness}];
    (signal == 1 ? both.second : both.first) += 1;
  }

  Defined<MetaD> meta() const {
    if (given.empty()) {
      return Undefined{"there are no ratings"};
    }
    RatingCounts counts;
    std::size_t no = 0;
    for (const auto& [answer, both] : given) {
      counts.noise.push_back(both.first);
      counts.signal.push_back(both.second);
      no += answer.first == 0 ? 1U : 0U;
    }
    return meta_d_prime(counts, no);
  }
};

struct Collected {
  DetectionCounts counts;
  /// From the surest "no" to the surest "yes", whatever numbers the scale has: noise, signal.
  std::map<std::pair<int, double>, std::pair<int, int>> ratings;
  AnswerRatings by_answer;
};

/// How sure; NaN: not rated.
double rating_of(const StudyTrial& trial, const TrialsPlan& plan) {
  const GivenAnswer* rating = plan.rating.empty() ? nullptr : answer_to(trial, plan.rating);
  return rating == nullptr ? kNotKnown : rating->value;
}

void add(Collected& collected, int signal, int outcome, double rating) {
  DetectionCounts& c = collected.counts;
  double& count = signal == 1 ? (outcome == 1 ? c.hits : c.misses)
                              : (outcome == 1 ? c.false_alarms : c.correct_rejections);
  count += 1.0;
  if (std::isfinite(rating)) {
    auto& both = collected.ratings[{outcome, outcome == 1 ? rating : -rating}];
    (signal == 1 ? both.second : both.first) += 1;
    collected.by_answer.add(signal, outcome, rating);
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
    const int outcome = answer->text == yes_of(plan) ? 1 : 0;
    const int signal = signal_in(trial, plan, outcome);
    if (signal >= 0) {
      add(all[{data.session_of(trial).participant, factors_of(data, trial, plan)}], signal, outcome,
          rating_of(trial, plan));
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
    if (plan.metacognition) {
      one.meta = collected.by_answer.meta();
    }
    result.push_back(std::move(one));
  }
  return result;
}

namespace {

constexpr double kNormal95 = 1.959963984540054;  // two-sided

/// Counts of a participant under a condition.
struct Tally {
  std::map<std::string, std::vector<int>> answers;  // stimulus -> of each choice
  std::map<double, std::pair<int, int>> ratings;    // value -> of wrong and of right answers
  AnswerRatings by_answer;                          // of two choices
  int trials{0}, right{0};
};

void count_answer(Tally& tally, const StudyTrial& trial, const GivenAnswer& answer,
                  const std::string& stimulus, const TrialsPlan& plan) {
  const auto choice = std::find(plan.choices.begin(), plan.choices.end(), answer.text);
  auto& row = tally.answers[stimulus];
  row.resize(plan.choices.size(), 0);
  ++row[static_cast<std::size_t>(choice - plan.choices.begin())];
  ++tally.trials;
  tally.right += answer.correct;
  const GivenAnswer* rating = plan.rating.empty() ? nullptr : answer_to(trial, plan.rating);
  if (rating != nullptr && std::isfinite(rating->value)) {
    auto& [wrong, right] = tally.ratings[rating->value];
    ++(answer.correct == 1 ? right : wrong);
    const std::string& last = plan.choices.at(static_cast<std::size_t>(plan.alternatives()) - 1);
    const int signal = stimulus == last ? 1 : 0;
    if (plan.metacognition && (signal == 1 || stimulus == plan.choices.front())) {
      tally.by_answer.add(signal, answer.text == last ? 1 : 0, rating->value);
    }
  }
}

/// Stimuli that are called as choices stand in the choices' order, others behind them.
Confusions confusions_of(const Tally& tally, const std::vector<std::string>& choices) {
  Confusions confusions;
  const auto take = [&](const auto& row) {
    confusions.stimuli.push_back(row.first);
    confusions.answers.push_back(row.second);
  };
  for (const std::string& choice : choices) {
    if (const auto row = tally.answers.find(choice); row != tally.answers.end()) {
      take(*row);
    }
  }
  for (const auto& row : tally.answers) {
    if (std::find(choices.begin(), choices.end(), row.first) == choices.end()) {
      take(row);
    }
  }
  return confusions;
}

double d_prime_of(double share, const TrialsPlan& plan) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  if (share >= 1.0) {
    return kEndless;
  }
  if (share <= 0.0) {
    const bool signed_d = plan.discrimination == DiscriminationTask::kForcedChoice ||
                          plan.discrimination == DiscriminationTask::kOneInterval;
    return signed_d ? -kEndless : 0.0;
  }
  const Defined<double> d = task_d_prime(plan.discrimination, share, plan.alternatives());
  return d ? *d : kNotKnown;
}

void add_d_prime(IdentifiedCondition& one, const TrialsPlan& plan) {
  const double half = 0.5 / one.trials;
  one.d_prime = task_d_prime(plan.discrimination, std::clamp(one.share, half, 1.0 - half),
                             plan.alternatives());
  one.d_low = d_prime_of(one.low, plan);
  one.d_high = d_prime_of(one.high, plan);
}

void add_ratings(const Tally& tally, IdentifiedCondition& one) {
  RatingCounts counts;
  double sums[2] = {0.0, 0.0};
  int given[2] = {0, 0};
  for (const auto& [value, of] : tally.ratings) {
    counts.noise.push_back(of.first);
    counts.signal.push_back(of.second);
    sums[0] += value * of.first;
    sums[1] += value * of.second;
    given[0] += of.first;
    given[1] += of.second;
  }
  if (given[0] > 0) {
    one.sure_wrong = sums[0] / given[0];
  }
  if (given[1] > 0) {
    one.sure_right = sums[1] / given[1];
  }
  if (counts.noise.size() > 1) {
    one.sureness = rating_roc(counts);
  }
}

}  // namespace

ShareInterval wilson_interval(int right, int trials) noexcept {
  const double n = trials, p = right / n, z2 = kNormal95 * kNormal95;
  const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half =
      kNormal95 / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return {right == 0 ? 0.0 : middle - half, right == trials ? 1.0 : middle + half};
}

std::vector<IdentifiedCondition> identified(const TrialsData& data, const TrialsPlan& plan) {
  std::map<std::pair<std::string, std::vector<std::string>>, Tally> all;
  for (const StudyTrial& trial : data.trials) {
    const GivenAnswer* answer = answer_to(trial, plan.question);
    const std::string stimulus = factor_level(data, trial, plan.stimulus);
    const bool known =
        answer != nullptr && answer->correct >= 0 && !stimulus.empty() &&
        std::find(plan.choices.begin(), plan.choices.end(), answer->text) != plan.choices.end();
    if (trial.counts() && known) {
      count_answer(all[{data.session_of(trial).participant, factors_of(data, trial, plan)}], trial,
                   *answer, stimulus, plan);
    }
  }
  std::vector<IdentifiedCondition> result;
  for (const auto& [key, tally] : all) {
    IdentifiedCondition& one = result.emplace_back();
    one.participant = key.first;
    one.levels = key.second;
    one.condition = fmt::format("{}", fmt::join(one.levels, ", "));
    one.confusions = confusions_of(tally, plan.choices);
    one.trials = tally.trials;
    one.right = tally.right;
    one.share = static_cast<double>(one.right) / one.trials;
    const ShareInterval interval = wilson_interval(one.right, one.trials);
    one.low = interval.low;
    one.high = interval.high;
    add_d_prime(one, plan);
    if (one.confusions.stimuli.size() > 2) {
      one.information = information_transfer(one.confusions.answers);
    }
    add_ratings(tally, one);
    if (plan.metacognition) {
      one.meta = tally.by_answer.meta();
    }
  }
  return result;
}

std::vector<std::pair<std::string, Confusions>> pooled_confusions(
    const std::vector<IdentifiedCondition>& all) {
  std::map<std::string, Confusions> sums;
  for (const IdentifiedCondition& one : all) {
    Confusions& sum = sums[one.condition];
    for (std::size_t row = 0; row < one.confusions.stimuli.size(); ++row) {
      const std::vector<int>& counts = one.confusions.answers[row];
      const auto found =
          std::find(sum.stimuli.begin(), sum.stimuli.end(), one.confusions.stimuli[row]);
      if (found == sum.stimuli.end()) {
        sum.stimuli.push_back(one.confusions.stimuli[row]);
        sum.answers.push_back(counts);
        continue;
      }
      std::vector<int>& of = sum.answers[static_cast<std::size_t>(found - sum.stimuli.begin())];
      std::transform(of.begin(), of.end(), counts.begin(), of.begin(), std::plus<>());
    }
  }
  return {sums.begin(), sums.end()};
}

}  // namespace haptrial::analysis::trials
