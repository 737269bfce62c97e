#pragma once

#include <filesystem>
#include <span>

#include "analysis/exchange/export_sessions.h"
#include "analysis/force_training/score/score_parameters.h"

namespace haptrial::exchange {

struct CurvesSummary {
  std::size_t subjects{0};
  std::size_t trials{0};
};

/// Writes the two curves of every test pass that has a score as a CSV file (target_force,
/// applied_force [N]), and conditions.csv, which says of which trial each is: what import_curves()
/// reads, and an example of it.
/// @param parameters  of the study's scores: whether curves are over time or over the path
/// @param folder  new or empty; it appears whole or not at all.
/// @throws InputError when there is no file, one is damaged or given twice, or two share a subject;
/// RunError when the disk is full.
CurvesSummary export_curves(std::span<const std::filesystem::path> files,
                            const std::filesystem::path& folder,
                            const analysis::ScoreParameters& parameters, int jobs,
                            const Watch& watch);

}  // namespace haptrial::exchange
