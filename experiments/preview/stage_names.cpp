#include "experiments/preview/stage_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace haptrial::experiments {

std::string stage_name(const protocols::PreviewedTrial& trial, const protocols::StagePlace& place) {
  const protocols::PreviewedInterval& shown = trial.intervals[place.interval];
  const std::string& name = shown.stages[place.stage].name;
  return trial.intervals.size() == 1
             ? name
             : fmt::format("{} {}: {}", place.interval + 1, shown.name, name);
}

std::string stage_names(const protocols::PreviewedTrial& trial,
                        const std::vector<protocols::StagePlace>& places) {
  std::vector<std::string> names;
  for (const protocols::StagePlace& place : places) {
    names.push_back(stage_name(trial, place));
  }
  return fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace haptrial::experiments
