#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/contact/demo_study/demo_study_tables.h"
#include "analysis/contact/demo_study/failure_map.h"

namespace haptrial::evaluation {

/// The tables beside the source's numbers, and how many cells of each map end how, as lines for a
/// terminal.
std::vector<std::string> demo_study_lines(const DemoStudyTables& tables,
                                          const std::vector<FailureMap>& maps);

/// table-4.csv, table-5.csv, table-6.csv (a function of the seed), operations.csv, costs.csv (of
/// this computer), figure-62 to figure-64, figure-65-RENDERER (.svg, .png), failures.csv and
/// report.html, all of them or none.
/// @throws InputError when `folder` holds anything or cannot be made; RunError as draw_figures().
void write_demo_study(const DemoStudyTables& tables, const std::vector<FailureMap>& maps,
                      const std::filesystem::path& folder);

}  // namespace haptrial::evaluation
