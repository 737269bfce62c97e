#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/statistics/design/design_tests.h"

namespace haptrial::analysis {

/// A line for each effect and planned test, for the console and the top of a report.
std::vector<std::string> effect_lines(const DesignTests& tests);
std::vector<std::string> planned_lines(const DesignTests& tests);
/// A line for each significant test of two sides that was not planned.
std::vector<std::string> unplanned_lines(const DesignTests& tests);

/// Everything that a design's tests found, as lines of plain text.
std::vector<std::string> design_lines(const DesignTable& table, const DesignTests& tests);

/// The observations of a table with a row for each value.
struct ObservedTable {
  std::vector<Observation> observations;
  std::size_t rows{0};
  std::size_t left_out{0};  // rows with a field that is missing
};

/// @param subject  columns that together name a participant.
/// @param leave_out_missing  rows with a field that is empty, NA, NaN, N/A or "."; else they are
///   refused.
/// @throws InputError with file and line where a field is missing or a value is not a number.
ObservedTable read_observations(const std::string& file, const std::vector<std::string>& subject,
                                const std::vector<std::string>& factors, const std::string& value,
                                bool leave_out_missing);

}  // namespace haptrial::analysis
