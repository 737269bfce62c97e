#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

struct RegistrationOptions {
  int iterations{250};  // of each of the three resolutions of a step
  int threads{0};       // 0: one per processor, each with an ear; the result is the same
};

/// An ear that was registered to a scan.
struct RegisteredEar {
  std::vector<std::uint8_t> labels;  // of each voxel of the scan, the ear's own, or kBeyondEar
  double correlation{0.0};           // of the densities of bone at the end, 1 at best
};

/// Registers ears to a scan and carries their labels to it: rigid, affine, then cubic B-splines
/// with nodes 4 mm apart, each at three resolutions, by the normalized correlation of how dense
/// bone is. Voxels of soft structures and of the labyrinth count as empty, as a scan shows them.
/// elastix does it, a process of its own for each ear, and with the same seed each time.
/// Source: Klein et al. 2010; docs/algorithms/atlas.md.
///
/// @param scan  the bone to label; its frame is that of the patient, as the ears' are
/// @param ears  of the same side; each overlaps the scan when their middles do
/// @throws RunError where elastix is missing or fails; geometry::Cancelled.
std::vector<RegisteredEar> register_ears(const BoneModel& scan, std::span<const BoneModel> ears,
                                         const RegistrationOptions& options = {},
                                         const geometry::WorkReport& report = {});

/// Whether a CT shows a structure as bone. Soft structures it does not, nor the labyrinth, which
/// fluid fills.
inline bool looks_like_bone(const Structure& structure) {
  return structure.hardness >= 1.0 && structure.name != "bony labyrinth";
}

}  // namespace haptrial::bone
