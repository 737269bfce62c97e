#pragma once

#include <vector>

#include "core/deformable/calibration/load_error.h"
#include "experiments/command/deform/deform_body.h"

namespace haptrial::experiments {

/// Part of a load in a calibration: followed, held out to decide which constants are kept, or
/// unseen, which judges alone.
enum class LoadPart { kSeen, kHeldOut, kUnseen };

/// A load of a calibration with its answer.
struct AnsweredLoad {
  NamedLoad named;
  deformable::CalibrationLoad answer;
  LoadPart part{LoadPart::kSeen};
};

/// Positions of the body under each load, by elements or by a file, and under `made` loads that the
/// program makes where the body is least known (made_loads.h): one is followed, the next held out.
/// @throws InputError if every load is unseen, or loads are to be made beside references of files.
std::vector<AnsweredLoad> answered_loads(const DeformBody& body,
                                         const std::vector<NamedLoad>& loads, int made,
                                         const MemoryBudget& budget);

/// The answers of one part.
std::vector<deformable::CalibrationLoad> answers_of(const std::vector<AnsweredLoad>& loads,
                                                    LoadPart part);

}  // namespace haptrial::experiments
