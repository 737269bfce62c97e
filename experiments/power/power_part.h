#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/power/power_question.h"
#include "experiments/power/power_unit.h"

namespace haptrial::experiments {

/// The text of a part: what was simulated, with which definition and program, and a checksum.
std::string part_text(const PowerQuestion& question, const PowerUnit& unit,
                      const std::vector<SimulatedStudy>& replications);

/// Reports in a part.
/// @throws InputError for a part that is damaged, or of another definition, program or unit
std::vector<SimulatedStudy> read_part(const std::filesystem::path& file,
                                      const PowerQuestion& question, const PowerUnit& unit);

}  // namespace haptrial::experiments
