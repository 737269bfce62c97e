#pragma once

#include <vector>

#include "core/bone/atlas/fuse_labels.h"
#include "core/bone/atlas/register_ears.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// Labels that other ears gave to a scan.
struct CarriedLabels {
  std::vector<CarriedStructure> structures;
  std::vector<double> correlations;  // of each ear with the scan, as register_ears() has them
};

/// Labels a scan by other ears: those of the other side are mirrored, all are registered, and their
/// labels are fused. Structures have the names that the ears give them; what the scan has as a
/// structure already stays.
/// Source: Morris 2006, §8.3.2.1 (which leaves it open); docs/algorithms/atlas.md.
/// @param scan  with plain bone at least; receives the labels, and its source says by what
/// @throws InputError for an ear whose structures do not tell its side, or without any structure;
/// as register_ears() does.
CarriedLabels label_scan(BoneModel& scan, EarSide side, std::vector<BoneModel> ears,
                         const RegistrationOptions& options = {},
                         const geometry::WorkReport& report = {});

}  // namespace haptrial::bone
