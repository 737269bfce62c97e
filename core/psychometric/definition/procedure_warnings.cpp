#include "core/psychometric/definition/procedure_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/psychometric/definition/track.h"
#include "core/psychometric/procedure/quest_plus.h"

namespace haptrial::psychometric {
namespace {

using Texts = std::vector<std::string>;

/// The least that the best first trial should tell, of which a track of some 50 makes 0.05 [nat].
constexpr double kLeastInformation = 1e-3;

void add_estimate(const Track& track, const StaircaseParameters& p, Texts& words) {
  const bool levels = p.estimator == StaircaseParameters::Estimator::kMeanOfLevels;
  const int most = levels                 ? p.stop_trials
                   : p.stop_reversals > 0 ? std::min(p.stop_reversals, p.stop_trials)
                                          : p.stop_trials;
  if (p.skip >= most) {
    words.push_back(
        fmt::format("{}: the estimate skips {} {}, and the track stops at {}, so that there will "
                    "never be an estimate",
                    track.name, p.skip, levels ? "trials" : "reversals", most));
  }
}

void add_steps(const Track& track, const StaircaseParameters& p, Texts& words) {
  const bool trials = p.schedule == StaircaseParameters::Schedule::kTrials;
  const int most = !trials && p.stop_reversals > 0 ? p.stop_reversals : p.stop_trials;
  const auto unused =
      std::ranges::count_if(p.steps, [&](const StaircaseStep& step) { return step.from >= most; });
  if (unused > 0) {
    words.push_back(
        fmt::format("{}: {} of {} sizes of steps are never used, since the track stops "
                    "at {} {}",
                    track.name, unused, p.steps.size(), most, trials ? "trials" : "reversals"));
  }
}

/// Mutual information of the answer to a stimulus and the parameters, before the first trial [nat].
double information(const QuestTables& tables, std::size_t stimulus) {
  double known = 0.0, all = 0.0;
  for (std::size_t outcome = 0; outcome <= tables.outcomes(); ++outcome) {
    const double* row = tables.likelihood(stimulus, outcome);
    double mean = 0.0;
    for (std::size_t cell = 0; cell < tables.cells(); ++cell) {
      mean += tables.prior()[cell] * row[cell];
    }
    if (outcome == tables.outcomes()) {
      known = mean;
    } else if (mean > 0.0) {
      all -= mean * std::log(mean);
    }
  }
  return all - known;
}

bool thresholds_are_outside(const QuestDefinition& quest) {
  const auto threshold =
      std::ranges::find(quest.parameters, std::string("threshold"), &QuestDimension::name);
  if (threshold == quest.parameters.end() || quest.stimulus.size() > 1) {
    return false;
  }
  const auto [low, high] = std::ranges::minmax(quest.stimulus.front().values);
  return std::ranges::none_of(threshold->values,
                              [&](double value) { return value >= low && value <= high; });
}

void add_quest(const Track& track, const QuestTables& tables, Texts& words) {
  const QuestDefinition& quest = tables.definition();
  if (std::ranges::all_of(quest.parameters,
                          [](const QuestDimension& each) { return each.values.size() == 1; })) {
    words.push_back(
        fmt::format("{}: every parameter has one value, so that no answer can change the estimate; "
                    "give the threshold several",
                    track.name));
    return;
  }
  if (thresholds_are_outside(quest)) {
    words.push_back(
        fmt::format("{}: no threshold that is considered lies within the levels, {:g} to {:g} {}",
                    track.name, track.low, track.high, track.unit));
  }
  double most = 0.0;
  for (std::size_t stimulus = 0; stimulus < tables.stimuli(); ++stimulus) {
    most = std::max(most, information(tables, stimulus));
  }
  if (most < kLeastInformation) {
    words.push_back(fmt::format(
        "{}: answers to no level tell the values of the parameters apart, so that little is learnt",
        track.name));
  }
}

}  // namespace

Texts procedure_warnings(const Track& track) {
  Texts words;
  if (track.staircase) {
    add_estimate(track, *track.staircase, words);
    add_steps(track, *track.staircase, words);
  } else if (track.begin) {
    const auto procedure = track.begin(0, track.name);
    if (const auto* quest = dynamic_cast<const QuestPlus*>(procedure.get())) {
      add_quest(track, quest->tables(), words);
    }
  }
  return words;
}

}  // namespace haptrial::psychometric
