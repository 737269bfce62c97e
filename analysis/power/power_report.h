#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/power/power_result.h"

namespace haptrial::analysis {

/// Power over participants, a line with its band for each combination of the other keys; over the
/// first key if participants do not vary. Empty series where nothing was found.
Figure power_figure(const PowerResult& result);

/// The report in words and tables. @param drawing  of power_figure()
Document power_report(const PowerResult& result, const Drawing& drawing);

/// A row for each cell: levels, replications, failures, rejections with interval, the effect.
std::string power_csv(const PowerResult& result);
/// Every number of the report.
std::string power_json(const PowerResult& result);

/// Lines for the terminal.
std::vector<std::string> power_lines(const PowerResult& result);

/// report.html, report.md, power.csv, power.json and the figure. @throws RunError, InputError
void write_power(const PowerResult& result, const std::filesystem::path& folder);

}  // namespace haptrial::analysis
