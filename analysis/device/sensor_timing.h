#pragma once

#include <vector>

#include "analysis/device/certificate_record.h"

namespace haptrial::analysis {

/// Gives each tick of a part the force that was measured nearest to it, of all that its ticks read.
/// @param tick_at  when each tick was, by the clock of part.measured_at and as many [s]
/// @returns the mean time from a measurement to its tick [s]; below 0 if they came after it
double align_forces(PartRecord& part, const std::vector<double>& tick_at);

}  // namespace haptrial::analysis
