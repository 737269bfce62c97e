#include "analysis/psychophysics/study/produced_quantities.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis::trials {
namespace {

/// Values of the trials of a participant under a condition.
struct Products {
  std::vector<double> values, errors;
};
using Cells = std::map<std::pair<std::string, std::vector<std::string>>, Products>;

/// The variable of the whole trial, or else of its last interval.
const GivenVariable* target_of(const StudyTrial& trial, const std::string& name) {
  const GivenVariable* last = variable_of(trial, name);
  for (const GivenVariable& each : trial.variables) {
    const bool later = last == nullptr || (last->interval > 0 && each.interval > last->interval);
    last = each.name == name && later ? &each : last;
  }
  return last;
}

/// @param sizes  whether signs do not count
double mean_of_all(const std::vector<double>& values, bool sizes) {
  double sum = 0.0;
  for (const double value : values) {
    sum += sizes ? std::abs(value) : value;
  }
  return sum / static_cast<double>(values.size());
}

/// A quantity of those cells for which the value is defined.
template <class Value>
Quantity quantity_of(const Cells& cells, const char* name, const std::string& title,
                     const TrialsPlan& plan, ValueRange range, Value value) {
  std::vector<QuantityValue> all;
  for (const auto& [of, cell] : cells) {
    if (const std::optional<double> one = value(cell)) {
      all.push_back({of.first, of.second, *one});
    }
  }
  return quantity(name, title, plan.produced.unit, all, plan, range);
}

std::vector<Quantity> produced_by_condition(const Cells& cells, const TrialsPlan& plan) {
  const auto mean = [](const std::vector<double>& of, bool sizes) {
    return of.empty() ? std::nullopt : std::optional(mean_of_all(of, sizes));
  };
  std::vector<Quantity> all{quantity_of(cells, "produced", plan.produced.words, plan,
                                        ValueRange::kAny,
                                        [&](const Products& p) { return mean(p.values, false); })};
  if (plan.produced.target.empty()) {
    return all;
  }
  all.push_back(quantity_of(cells, "constant_error", "constant error", plan, ValueRange::kAny,
                            [&](const Products& p) { return mean(p.errors, false); }));
  all.push_back(quantity_of(cells, "absolute_error", "absolute error", plan, ValueRange::kPositive,
                            [&](const Products& p) { return mean(p.errors, true); }));
  all.push_back(quantity_of(cells, "variable_error", "variable error", plan, ValueRange::kPositive,
                            [](const Products& p) -> std::optional<double> {
                              const auto m = moments(p.errors);
                              return m && m->count > 1 ? std::optional(std::sqrt(m->variance()))
                                                       : std::nullopt;
                            }));
  return all;
}

}  // namespace

std::vector<Quantity> produced_quantities(const TrialsData& data, const TrialsPlan& plan) {
  Cells cells;
  for (const StudyTrial& trial : data.trials) {
    const GivenAnswer* measured =
        trial.counts() ? answer_to(trial, plan.produced.measure) : nullptr;
    if (measured == nullptr || !std::isfinite(measured->value)) {
      continue;
    }
    Products& cell = cells[{data.session_of(trial).participant, factors_of(data, trial, plan)}];
    cell.values.push_back(measured->value);
    const GivenVariable* target = target_of(trial, plan.produced.target);
    if (target != nullptr && std::isfinite(target->value)) {
      cell.errors.push_back(measured->value - target->value);
    }
  }
  return produced_by_condition(cells, plan);
}

namespace {

template <class Condition>
std::vector<Quantity> quantities_of_ratings(const std::vector<Condition>& all,
                                            const TrialsPlan& plan) {
  std::vector<QuantityValue> meta, ratio;
  for (const Condition& one : all) {
    if (one.meta) {
      meta.push_back({one.participant, one.levels, one.meta->meta_d});
      ratio.push_back({one.participant, one.levels, one.meta->ratio});
    }
  }
  return {quantity("meta_d", "meta-d'", "", meta, plan),
          quantity("m_ratio", "M-ratio (meta-d' / d')", "", ratio, plan)};
}

}  // namespace

std::vector<Quantity> diffusion_quantities(const std::vector<TimedCondition>& all,
                                           const TrialsPlan& plan) {
  const TrialsPlan two_sided = without_directions(plan);
  const auto values = [&](DiffusionEstimate DiffusionFit::*parameter) {
    std::vector<QuantityValue> of;
    for (const TimedCondition& one : all) {
      if (one.diffusion) {
        of.push_back({one.participant, one.levels, ((*one.diffusion).*parameter).value});
      }
    }
    return of;
  };
  return {quantity("drift", "drift rate", "", values(&DiffusionFit::drift), two_sided),
          quantity("boundary", "boundary separation", "", values(&DiffusionFit::boundary),
                   two_sided, ValueRange::kPositive),
          quantity("non_decision_time", "non-decision time", "s",
                   values(&DiffusionFit::non_decision), two_sided, ValueRange::kPositive)};
}

std::vector<Quantity> metacognition_quantities(const std::vector<DetectedCondition>& all,
                                               const TrialsPlan& plan) {
  return quantities_of_ratings(all, plan);
}

std::vector<Quantity> metacognition_quantities(const std::vector<IdentifiedCondition>& all,
                                               const TrialsPlan& plan) {
  return quantities_of_ratings(all, plan);
}

}  // namespace haptrial::analysis::trials
