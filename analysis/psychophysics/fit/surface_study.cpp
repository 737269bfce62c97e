#include "analysis/psychophysics/fit/surface_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/threshold_surface.h"

namespace haptrial::analysis::trials {
namespace {

constexpr std::size_t kPoints = 9;        // of the contour, in tables
constexpr std::size_t kDrawnPoints = 17;  // of a contour without a formula; every other is told

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

/// The line through the thresholds of the first variable over the second, which is drawn to the
/// right.
Contour contour_of(const std::vector<double>& over,
                   const std::vector<psychometric::SurfaceThreshold>& found, double share) {
  Contour contour{share, {}, {}, {}};
  const auto add = [&](std::vector<Segment>& line, double psychometric::SurfaceThreshold::*of,
                       std::size_t i) {
    if (std::isfinite(found[i].*of) && std::isfinite(found[i + 1].*of)) {
      line.push_back({{over[i], found[i].*of}, {over[i + 1], found[i + 1].*of}});
    }
  };
  for (std::size_t i = 0; i + 1 < over.size(); ++i) {
    add(contour.middle, &psychometric::SurfaceThreshold::median, i);
    add(contour.hardly, &psychometric::SurfaceThreshold::low, i);
    add(contour.sure, &psychometric::SurfaceThreshold::high, i);
  }
  return contour;
}

std::vector<psychometric::SurfaceThreshold> thresholds_over(
    const psychometric::SurfacePosterior& surface, const std::vector<double>& over) {
  std::vector<psychometric::Level> others;
  for (const double each : over) {
    others.push_back({each});
  }
  return surface.thresholds(others);
}

std::vector<double> spaced(const std::vector<double>& levels, std::size_t count) {
  std::vector<double> some;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    some.push_back(levels.front() + share * (levels.back() - levels.front()));
  }
  return some;
}

/// NaN, which is open, for an end beyond the levels.
double end_of(double level) {
  return std::isfinite(level) ? level : std::numeric_limits<double>::quiet_NaN();
}

/// Thresholds over several other variables, at a few of their levels.
void place_thresholds(SurfaceCondition& one, const psychometric::SurfacePosterior& surface) {
  const std::vector<psychometric::Level> others = surface.told_at();
  const auto found = surface.thresholds(others);
  for (std::size_t i = 0; i < others.size(); ++i) {
    one.placed.push_back(
        {others[i], end_of(found[i].median), end_of(found[i].low), end_of(found[i].high)});
  }
  one.no_contour = "it is drawn over two variables; a table has thresholds at a few levels";
}

/// A surface without a formula, from the answers of all sessions.
/// @param surface  before any answer
void fit_smooth(SurfaceCondition& one, psychometric::SurfacePosterior surface) {
  for (const SurfaceTrial& trial : one.trials) {
    surface.report(trial.outcome == 1, trial.stimulus);
  }
  one.fit = SurfaceFit{one.trials.size(), {}, {}};
  one.share = surface.parameters().target;
  if (one.variables.size() != 2) {
    place_thresholds(one, surface);
    return;
  }
  const std::vector<double>& levels = surface.parameters().variables[1].levels;
  const std::vector<double> drawn = spaced(levels, kDrawnPoints);
  const auto found = thresholds_over(surface, drawn);
  one.contour = contour_of(drawn, found, one.share);
  for (std::size_t i = 0; i < drawn.size(); i += kDrawnPoints / kPoints) {
    ContourPoint point{drawn[i], {}, end_of(found[i].low), end_of(found[i].high)};
    if (std::isfinite(found[i].median)) {
      point.second = {found[i].median};
    }
    one.points.push_back(std::move(point));
  }
  std::swap(one.variables[0], one.variables[1]);
  one.shares_unit = false;
  for (SurfaceTrial& trial : one.trials) {
    std::swap(trial.stimulus[0], trial.stimulus[1]);
  }
}

void fit(SurfaceCondition& one, const psychometric::Procedure* procedure) {
  if (const auto* smooth = dynamic_cast<const psychometric::ThresholdSurface*>(procedure)) {
    fit_smooth(one, smooth->posterior());
    return;
  }
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
