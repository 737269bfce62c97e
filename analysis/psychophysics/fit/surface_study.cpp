#include "analysis/psychophysics/fit/surface_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/psychometric/procedure/quest_plus.h"

namespace haptrial::analysis::trials {
namespace {

constexpr std::size_t kPoints = 9;  // of the contour, in tables

void add_contour(SurfaceCondition& one, const psychometric::QuestDefinition& definition) {
  if (one.variables.size() != 2) {
    one.no_contour = fmt::format("it is drawn over two variables, and the stimulus has {}",
                                 one.variables.size());
    return;
  }
  try {
    const ThresholdMap map(definition, *one.fit, one.share);
    one.contour = map.contour();
    one.points = map.points(kPoints);
  } catch (const std::invalid_argument& error) {
    one.no_contour = error.what();
  }
  if (one.contour && one.contour->middle.empty()) {
    one.no_contour = "no level within the ranges of the variables has this share";
  }
}

void fit(SurfaceCondition& one, const psychometric::Procedure* procedure) {
  const auto* quest = dynamic_cast<const psychometric::QuestPlus*>(procedure);
  if (quest == nullptr) {
    one.fit = Undefined{"its procedure states no function of several variables"};
    return;
  }
  const psychometric::QuestDefinition& definition = quest->tables().definition();
  try {
    one.fit = fit_surface(definition, one.trials);
    add_contour(one, definition);
  } catch (const std::invalid_argument& error) {
    one.fit = Undefined{error.what()};
  }
}

SurfaceCondition& condition_of(std::vector<SurfaceCondition>& all, const TrialsData& data,
                               const StudyTrial& trial, const std::vector<std::string>& by) {
  SurfaceCondition made;
  made.participant = data.session_of(trial).participant;
  made.track = trial.levels.front().track;
  for (const std::string& factor : by) {
    made.levels.push_back(factor_level(data, trial, factor));
  }
  const auto at = std::find_if(all.begin(), all.end(), [&made](const SurfaceCondition& each) {
    return each.participant == made.participant && each.track == made.track &&
           each.levels == made.levels;
  });
  if (at != all.end()) {
    return *at;
  }
  made.condition = fmt::format("{}", fmt::join(made.levels, ", "));
  for (const GivenLevel& level : trial.levels) {
    made.variables.push_back(level.variable);
  }
  all.push_back(std::move(made));
  return all.back();
}

}  // namespace

bool has_surface(const StudyTrial& trial) { return trial.levels.size() > 1; }

std::vector<SurfaceCondition> surface_conditions(
    const TrialsData& data, const std::vector<std::string>& by, double share,
    const std::function<std::unique_ptr<psychometric::Procedure>(const std::string&)>& begin) {
  std::vector<SurfaceCondition> all;
  for (const StudyTrial& trial : data.trials) {
    if (!trial.counts() || !has_surface(trial) || !(trial.levels.front().outcome >= 0.0)) {
      continue;
    }
    SurfaceTrial made;
    for (const GivenLevel& level : trial.levels) {
      made.stimulus.push_back(level.applied);
    }
    made.outcome = static_cast<std::size_t>(std::lround(trial.levels.front().outcome));
    condition_of(all, data, trial, by).trials.push_back(std::move(made));
  }
  for (SurfaceCondition& one : all) {
    one.share = share;
    const auto procedure = begin ? begin(one.track) : nullptr;
    fit(one, procedure.get());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const SurfaceCondition& a, const SurfaceCondition& b) {
                     return a.participant < b.participant;
                   });
  return all;
}

}  // namespace haptrial::analysis::trials
