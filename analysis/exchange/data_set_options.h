#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/definition/definition_changes.h"
#include "core/record/rows/session_types.h"

namespace haptrial::exchange {

/// Differences between the definitions of two sessions; binding changes make them two studies.
using CompareDefinitions = std::function<DefinitionChanges(const record::SessionInfo& first,
                                                           const record::SessionInfo& second)>;

/// How a data set of BIDS or Psych-DS is to be written.
struct DataSetOptions {
  std::string name{};                  // of the data set; empty: the experiment's
  std::vector<std::string> authors{};  // as the data set is to name them
  std::string program_version{};       // of the exporting program
  std::vector<std::pair<std::string, std::string>> phases{};  // of protocols, with meanings
  double motion{0.0};  // in BIDS, rate of the tip's movement beside the recording [Hz]; 0: without
  int jobs{1};
  CompareDefinitions compare{};  // none: every difference is binding
};

}  // namespace haptrial::exchange
