#include "analysis/trials/psychometric/serial.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/psychometric/models/binomial_model.h"

namespace haptrial::analysis::trials {
namespace {

constexpr double kMostLogit = 7.0;

/// A trial beside its function.
struct Seen {
  std::size_t trial{0};  // in TrialsData::trials
  double offset{0.0};    // logit psi
  int outcome{0};
  int choice{0};  // +-1
  int side{1};    // +-1
};

double logit(double p) { return std::clamp(std::log(p / (1.0 - p)), -kMostLogit, kMostLogit); }

double variance_at(double offset) {
  const double p = 1.0 / (1.0 + std::exp(-offset));
  return p * (1.0 - p);
}

BinomialData empty_rows(std::size_t count, Eigen::Index predictors) {
  BinomialData data;
  data.yes.reserve(count);
  data.trials.assign(count, 1);
  data.predictors.resize(static_cast<Eigen::Index>(count), predictors);
  return data;
}

/// Coefficient of the last predictor.
Defined<double> last_coefficient(const BinomialData& data) {
  const auto model = binomial_regression(data, BinomialLink::kLogit);
  if (!model) {
    return Undefined{model.because()};
  }
  return model->coefficients.back().estimate;
}

Defined<double> drift_of(const std::vector<Seen>& seen) {
  BinomialData data = empty_rows(seen.size(), 2);
  const double last = std::max(1.0, static_cast<double>(seen.size()) - 1.0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    data.yes.push_back(seen[i].outcome);
    const auto row = static_cast<Eigen::Index>(i);
    data.predictors(row, 0) = seen[i].offset;
    data.predictors(row, 1) = static_cast<double>(i) / last - 0.5;
  }
  return last_coefficient(data);
}

/// @param before  the choice of the trial before in the session; 0: none
Defined<double> repetition_of(const std::vector<Seen>& seen, const std::vector<int>& before) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (before[i] != 0) {
      used.push_back(i);
    }
  }
  BinomialData data = empty_rows(used.size(), 2);
  double weight = 0.0;
  for (std::size_t k = 0; k < used.size(); ++k) {
    const Seen& one = seen[used[k]];
    data.yes.push_back(one.choice > 0 ? 1 : 0);
    const auto row = static_cast<Eigen::Index>(k);
    data.predictors(row, 0) = one.side * one.offset;
    data.predictors(row, 1) = 0.5 * before[used[k]];
    weight += variance_at(one.offset);
  }
  const Defined<double> found = last_coefficient(data);
  return found ? Defined<double>(*found + 1.0 / weight) : found;
}

/// The trials of one participant that have a function, in the order of their recording.
std::vector<Seen> seen_by(const std::string& participant, const std::vector<AnsweredSeries>& series,
                          const std::vector<FunctionFit>& fits, const TrialsPlan& plan,
                          SerialEffects& effects) {
  constexpr double kEasy = 0.99;
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i].participant != participant || !fits[i].likelihood) {
      continue;
    }
    const auto function = fits[i].function(plan);
    const auto& p = function.parameters();
    for (const LevelTrial& trial : series[i].trials) {
      const double psi = function(trial.level);
      if (!std::isfinite(plan.function.axis.at(trial.level))) {
        continue;
      }
      const bool chosen = trial.choice != 0;
      seen.push_back({trial.trial, logit(psi), trial.outcome,
                      chosen ? trial.choice : 2 * trial.outcome - 1, chosen ? trial.side : 1});
      if ((psi - p.guess) / (1.0 - p.guess - p.lapse) > kEasy) {
        ++effects.easy;
        effects.easy_wrong += trial.outcome == 0 ? 1 : 0;
      }
    }
  }
  std::sort(seen.begin(), seen.end(),
            [](const Seen& a, const Seen& b) { return a.trial < b.trial; });
  return seen;
}

std::vector<int> choices_before(const TrialsData& data, const std::vector<Seen>& seen) {
  std::vector<int> before(seen.size(), 0);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    const StudyTrial& now = data.trials[seen[i].trial];
    const StudyTrial& last = data.trials[seen[i - 1].trial];
    before[i] = now.session == last.session ? seen[i - 1].choice : 0;
  }
  return before;
}

std::vector<double> defined_of(const std::vector<SerialEffects>& effects,
                               Defined<double> SerialEffects::*member) {
  std::vector<double> values;
  for (const SerialEffects& each : effects) {
    if (each.*member) {
      values.push_back(*(each.*member));
    }
  }
  return values;
}

}  // namespace

std::vector<SerialEffects> serial_effects(const TrialsData& data,
                                          const std::vector<AnsweredSeries>& series,
                                          const std::vector<FunctionFit>& fits,
                                          const TrialsPlan& plan) {
  std::map<std::string, SerialEffects> people;
  for (const AnsweredSeries& each : series) {
    SerialEffects& own = people[each.participant];
    own.participant = each.participant;
    own.trials += each.trials.size();
    for (const LevelTrial& trial : each.trials) {
      constexpr double kRounding = 1e-9;
      own.limited +=
          std::abs(trial.level - trial.asked) > kRounding * std::abs(trial.asked) ? 1 : 0;
    }
  }
  std::vector<SerialEffects> all;
  for (auto& [participant, own] : people) {
    const std::vector<Seen> seen = seen_by(participant, series, fits, plan, own);
    if (!seen.empty()) {
      own.drift = drift_of(seen);
      own.repetition = repetition_of(seen, choices_before(data, seen));
    }
    all.push_back(std::move(own));
  }
  return all;
}

Defined<TTest> against_zero(const std::vector<double>& values) {
  const std::vector<double> zeros(values.size(), 0.0);
  return paired_t_test(values, zeros, Tail::kTwoSided);
}

std::vector<double> drifts(const std::vector<SerialEffects>& effects) {
  return defined_of(effects, &SerialEffects::drift);
}
std::vector<double> repetitions(const std::vector<SerialEffects>& effects) {
  return defined_of(effects, &SerialEffects::repetition);
}

}  // namespace haptrial::analysis::trials
