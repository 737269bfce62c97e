#include "core/psychometric/definition/read_procedures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/psychometric/definition/track.h"
#include "core/psychometric/procedure/quest_plus.h"

namespace haptrial::psychometric {
namespace {

/// The least that the best first trial should tell, of which a track of some 50 makes 0.05 [nat].
constexpr double kLeastInformation = 1e-3;

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

}  // namespace

std::vector<std::string> quest_warnings(const Track& track, const QuestTables& tables) {
  const QuestDefinition& quest = tables.definition();
  if (std::ranges::all_of(quest.parameters,
                          [](const QuestDimension& each) { return each.values.size() == 1; })) {
    return {
        fmt::format("{}: every parameter has one value, so that no answer can change the estimate; "
                    "give the threshold several",
                    track.name)};
  }
  std::vector<std::string> words;
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
  return words;
}

}  // namespace haptrial::psychometric
