#include "analysis/psychophysics/fit/serial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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

namespace {

/// The variance of their mean is 1/25 of that of one session: a test over participants loses next
/// to nothing by it.
constexpr int kSessions = 25;
constexpr int kFewest = 8;  // of them that tell something

/// Nobody's track runs longer than the recorded one by this factor.
constexpr std::size_t kLongest = 10;

using Procedures = std::vector<std::unique_ptr<psychometric::Procedure>>;

class Rerun {
 public:
  Rerun(const SerialRecord& record, RandomStream& random) : record_(record), random_(random) {
    for (const SerialTrack& track : record.adaptive) {
      procedures_.push_back(track.begin());
    }
  }

  std::vector<SerialTrial> trials() {
    for (std::size_t i = 0; i < record_.trials.size(); ++i) {
      answer(i, false);
    }
    // Tracks that are not finished go on in the order of their trials.
    for (std::size_t round = 1; round < kLongest && unfinished(); ++round) {
      for (std::size_t i = 0; i < record_.trials.size(); ++i) {
        answer(i, true);
      }
    }
    return std::move(trials_);
  }

 private:
  bool unfinished() const {
    for (std::size_t t = 0; t < procedures_.size(); ++t) {
      if (record_.adaptive[t].finished && !procedures_[t]->finished()) {
        return true;
      }
    }
    return false;
  }

  /// @param further  after the recorded session's end
  void answer(std::size_t i, bool further) {
    SerialTrial trial = record_.trials[i];
    const auto& function = record_.functions[trial.series];
    psychometric::Procedure* procedure = nullptr;
    if (const int track = record_.tracks[i]; track >= 0) {
      procedure = procedures_[static_cast<std::size_t>(track)].get();
      if (procedure->finished() ||
          (further && !record_.adaptive[static_cast<std::size_t>(track)].finished)) {
        return;
      }
      trial.level = procedure->next().front();
    } else if (further) {
      return;
    }
    if (!function) {
      return;
    }
    trial.outcome = random_.uniform() < (*function)(trial.level) ? 1 : 0;
    trial.choice = trial.outcome == 1 ? trial.side : -trial.side;
    if (procedure != nullptr) {
      procedure->report(trial.outcome, {trial.level});
    }
    trials_.push_back(trial);
  }

  const SerialRecord& record_;
  RandomStream& random_;
  Procedures procedures_;
  std::vector<SerialTrial> trials_;
};

SerialFunctions fitted_anew(const std::vector<SerialTrial>& trials, std::size_t series,
                            const LikelihoodOptions& options) {
  std::vector<std::vector<TrialBlock>> blocks(series);
  for (const SerialTrial& trial : trials) {
    if (std::isfinite(options.function.axis.at(trial.level))) {
      blocks[trial.series].push_back({nine_digits(trial.level), trial.outcome, 1});
    }
  }
  SerialFunctions functions(series);
  for (std::size_t i = 0; i < series; ++i) {
    if (blocks[i].empty()) {
      continue;
    }
    const std::vector<TrialBlock> levels = pooled(blocks[i]);
    if (levels.size() < 2) {
      continue;
    }
    const LikelihoodFit fit = likelihood_fit(levels, options);
    if (!fit.undetermined) {
      functions[i] = fitted_function(options.function, fit.parameters);
    }
  }
  return functions;
}

/// A running mean of what is defined.
struct Mean {
  double sum{0.0};
  double squares{0.0};
  int count{0};

  void add(const Defined<double>& value) {
    if (value) {
      sum += *value;
      squares += *value * *value;
      ++count;
    }
  }
  /// Standard error of value().
  double error() const {
    const double n = count;
    return std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1.0) / n);
  }
  Defined<double> value() const {
    if (count < kFewest) {
      return Undefined{"too few sessions of such observers tell serial effects"};
    }
    return sum / count;
  }
};

}  // namespace

SerialCoefficients serial_coefficients_by_chance(const SerialRecord& record,
                                                 const LikelihoodOptions& options,
                                                 std::uint64_t seed) {
  RandomStream random(seed, "serial effects");
  Mean drift, repetition;
  for (int i = 0; i < kSessions; ++i) {
    const std::vector<SerialTrial> trials = Rerun(record, random).trials();
    const SerialCoefficients found =
        serial_coefficients(trials, fitted_anew(trials, record.functions.size(), options));
    drift.add(found.drift);
    repetition.add(found.repetition);
  }
  return {drift.value(), repetition.value(), drift.error(), repetition.error()};
}

}  // namespace haptrial::analysis::trials
