#pragma once

#include <filesystem>

#include "analysis/contact/evaluation/evaluation_report.h"

namespace haptrial::evaluation {

/// evaluation.json, contact.csv, objects.toml, report.html and its pictures (.svg, .png), all of
/// them or none.
/// @throws InputError when `folder` holds anything or cannot be made; RunError as draw_figures().
void write_evaluation(const Evaluation& evaluation, const EvaluationNames& names,
                      const std::filesystem::path& folder);

}  // namespace haptrial::evaluation
