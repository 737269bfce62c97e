#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::experiments {

/// "1 comparison: press"; without the interval in a trial of one.
std::string stage_name(const protocols::PreviewedTrial& trial, std::size_t interval,
                       std::size_t stage);

/// The names of stages, one after the other.
template <class Where>
std::string stage_names(const protocols::PreviewedTrial& trial, const std::vector<Where>& where) {
  std::vector<std::string> names;
  for (const Where& each : where) {
    names.push_back(stage_name(trial, each.interval, each.stage));
  }
  return fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace haptrial::experiments
