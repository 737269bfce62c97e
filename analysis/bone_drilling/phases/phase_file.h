#pragma once

#include <filesystem>
#include <string>

#include "analysis/bone_drilling/phases/phase_model.h"

namespace haptrial::analysis::drilling {

/// A model as a file (JSON).
std::string phase_model_text(const PhaseModel& model);
/// @throws InputError for a file that phase_model_text() did not write.
PhaseModel read_phase_model(const std::filesystem::path& file);

}  // namespace haptrial::analysis::drilling
