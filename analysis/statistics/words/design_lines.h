#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/design/design_tests.h"

namespace haptrial::analysis {

/// A line for each effect and planned test, for the console and the top of a report.
std::vector<std::string> effect_lines(const DesignTests& tests);
std::vector<std::string> planned_lines(const DesignTests& tests);

/// Everything that a design's tests found, as lines of plain text.
std::vector<std::string> design_lines(const DesignTable& table, const DesignTests& tests);

/// Observations of a table with a row for each value.
/// @param subject  columns that together name a participant.
/// @throws InputError with file and line where a name is empty or a value is not a number.
std::vector<Observation> read_observations(const std::string& file,
                                           const std::vector<std::string>& subject,
                                           const std::vector<std::string>& factors,
                                           const std::string& value);

}  // namespace haptrial::analysis
