#pragma once

#include <string>
#include <vector>

#include "experiments/command/deform/calibration_run.h"
#include "experiments/command/deform/deform_body.h"

namespace haptrial::experiments {

/// Writes report.html, calibration.json, constants.csv, evaluations.csv and the pictures into a new
/// folder, whole or not at all.
void write_calibration(const DeformBody& body, const deformable::SpringBody& springs,
                       const CalibrationRun& run, const std::string& folder);

/// The lines for the terminal.
std::vector<std::string> calibration_lines(const CalibrationRun& run);

}  // namespace haptrial::experiments
