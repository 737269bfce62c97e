#include "analysis/psychophysics/fit/serial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/psychophysics/fit/serial_null.h"
#include "core/base/parallel.h"
#include "core/base/random.h"

namespace haptrial::analysis::trials {
namespace {

/// Tracks by session and name.
using TrackMap = std::map<std::pair<std::size_t, std::string>, const TrackEstimate*>;

/// The sessions of one participant, as their series tell them.
class Recorded {
 public:
  Recorded(const TrialsData& data, const TrialsPlan& plan, const ProcedureOf& procedure_of)
      : data_(data), plan_(plan), procedure_of_(procedure_of) {}

  void add(const AnsweredSeries& series, const FunctionFit& fit, const TrackMap& tracks) {
    // Functions of simulated sessions are those of the likelihood, too.
    functions_.push_back(fit.likeliest
                             ? std::optional(fitted_function(plan_.function, *fit.likeliest))
                             : std::nullopt);
    for (const LevelTrial& trial : series.trials) {
      const std::size_t session = data_.trials[trial.trial].session;
      const bool chosen = trial.choice != 0;
      const SerialTrial answer{session,
                               functions_.size() - 1,
                               trial.level,
                               trial.outcome,
                               chosen ? trial.choice : 2 * trial.outcome - 1,
                               chosen ? trial.side : 1};
      const auto track = tracks.find({session, trial.track});
      const bool adaptive = track != tracks.end() && track->second->adaptive;
      rows_.push_back({trial.trial, answer, adaptive ? track->second : nullptr});
    }
  }

  SerialRecord record() {
    std::ranges::sort(rows_, {}, &Row::trial);
    SerialRecord record;
    record.functions = functions_;
    std::map<const TrackEstimate*, int> known;
    for (const Row& row : rows_) {
      record.trials.push_back(row.answer);
      int number = -1;
      if (row.track != nullptr) {
        const auto [at, first] = known.try_emplace(row.track, static_cast<int>(known.size()));
        number = at->second;
        if (first) {
          record.adaptive.push_back({row.track->finished, [this, name = row.track->track] {
                                       return procedure_of_(name);
                                     }});
        }
      }
      record.tracks.push_back(number);
    }
    return record;
  }

  /// Whether the procedures learnt what the functions are fitted to.
  bool repeatable() const {
    return plan_.yes.empty() && std::ranges::all_of(rows_, [this](const Row& row) {
             return row.track == nullptr || plan_.level.empty() ||
                    plan_.level == row.track->variable;
           });
  }

 private:
  struct Row {
    std::size_t trial{0};  // in TrialsData::trials
    SerialTrial answer;
    const TrackEstimate* track{nullptr};  // null: its levels were given
  };

  const TrialsData& data_;
  const TrialsPlan& plan_;
  const ProcedureOf& procedure_of_;
  std::vector<Row> rows_;
  SerialFunctions functions_;
};

void count_levels(SerialEffects& own, const AnsweredSeries& series, const FunctionFit& fit,
                  const TrialsPlan& plan) {
  constexpr double kEasy = 0.99;
  constexpr double kRounding = 1e-9;
  own.trials += series.trials.size();
  for (const LevelTrial& trial : series.trials) {
    own.limited += std::abs(trial.level - trial.asked) > kRounding * std::abs(trial.asked) ? 1 : 0;
  }
  if (!fit.stated) {
    return;
  }
  const auto function = fit.function(plan);
  const auto& p = function.parameters();
  for (const LevelTrial& trial : series.trials) {
    const double share = (function(trial.level) - p.guess) / (1.0 - p.guess - p.lapse);
    if (std::isfinite(plan.function.axis.at(trial.level)) && share > kEasy) {
      ++own.easy;
      own.easy_wrong += trial.outcome == 0 ? 1 : 0;
    }
  }
}

Defined<double> difference(const Defined<double>& found, const Defined<double>& by_chance) {
  return !found ? found : !by_chance ? by_chance : Defined<double>(*found - *by_chance);
}

void add_effects(SerialEffects& own, Recorded& recorded, const TrialsPlan& plan) {
  const SerialRecord record = recorded.record();
  const SerialCoefficients found = serial_coefficients(record.trials, record.functions);
  if (!record.adaptive.empty()) {
    const Undefined unknown{"no function of what the procedure learnt from is fitted"};
    own.by_chance = recorded.repeatable()
                        ? serial_coefficients_by_chance(record, likelihood_options(plan),
                                                        derived_seed(plan.seed, own.participant))
                        : SerialCoefficients{unknown, unknown};
  }
  own.effects = {difference(found.drift, own.by_chance.drift),
                 difference(found.repetition, own.by_chance.repetition),
                 std::hypot(found.drift_error, own.by_chance.drift_error),
                 std::hypot(found.repetition_error, own.by_chance.repetition_error)};
}

std::vector<double> defined_of(const std::vector<SerialEffects>& effects,
                               Defined<double> SerialCoefficients::*member) {
  std::vector<double> values;
  for (const SerialEffects& each : effects) {
    if (each.effects.*member) {
      values.push_back(*(each.effects.*member));
    }
  }
  return values;
}

}  // namespace

std::vector<SerialEffects> serial_effects(const TrialsData& data,
                                          const std::vector<AnsweredSeries>& series,
                                          const std::vector<FunctionFit>& fits,
                                          const std::vector<TrackEstimate>& tracks,
                                          const TrialsPlan& plan, const ProcedureOf& procedure_of,
                                          int threads) {
  TrackMap by_name;
  for (const TrackEstimate& track : tracks) {
    by_name[{track.session, track.track}] = &track;
  }
  std::map<std::string, std::pair<SerialEffects, Recorded>> people;
  for (std::size_t i = 0; i < series.size(); ++i) {
    auto& [own, recorded] =
        people
            .try_emplace(series[i].participant, SerialEffects{}, Recorded(data, plan, procedure_of))
            .first->second;
    own.participant = series[i].participant;
    count_levels(own, series[i], fits[i], plan);
    recorded.add(series[i], fits[i], by_name);
  }
  std::vector<std::pair<SerialEffects, Recorded>*> work;
  for (auto& [name, person] : people) {
    work.push_back(&person);
  }
  in_groups(work.size(), 1, threads, [&] {
    return [&](std::size_t i, std::size_t) { add_effects(work[i]->first, work[i]->second, plan); };
  });
  std::vector<SerialEffects> all;
  for (auto* person : work) {
    all.push_back(std::move(person->first));
  }
  return all;
}

Defined<TTest> against_zero(const std::vector<double>& values) {
  const std::vector<double> zeros(values.size(), 0.0);
  return paired_t_test(values, zeros, Tail::kTwoSided);
}

std::vector<double> drifts(const std::vector<SerialEffects>& effects) {
  return defined_of(effects, &SerialCoefficients::drift);
}
std::vector<double> repetitions(const std::vector<SerialEffects>& effects) {
  return defined_of(effects, &SerialCoefficients::repetition);
}

}  // namespace haptrial::analysis::trials
