#pragma once

#include <filesystem>
#include <vector>

#include "analysis/document/document.h"
#include "core/deformable/body/mesh_parts.h"
#include "experiments/command/deform/calibration_run.h"

namespace haptrial::experiments {

/// Pictures of a body under one load by our renderer: rest, reference, set by hand, calibrated, and
/// the last two coloured by their error. Small displacements are drawn larger, as the captions say.
/// @param number  of the load, in the names of the files
/// @param folder  receives NAME.png
std::vector<analysis::Drawing> calibration_pictures(const deformable::SpringBody& springs,
                                                    const JudgedLoad& load, std::size_t number,
                                                    const std::filesystem::path& folder);

}  // namespace haptrial::experiments
