#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/bone_drilling/metrics/achieved.h"
#include "analysis/bone_drilling/metrics/injuries.h"

namespace haptrial::analysis::drilling {

/// How a drilling stands.
struct LiveFigures {
  double time{0.0};                     // [s]
  double drilling{0.0};                 // [s]
  double removed{0.0};                  // bone [m^3]
  std::uint64_t voxels{0};              // emptied
  std::optional<double> visible_share;  // of them
  std::uint64_t injured_voxels{0};      // of vital structures, emptied
  std::vector<Injury> injuries;         // by vital structure
  std::optional<double> mean_force;     // while drilling [N]
  Achieved achieved;

  bool operator==(const LiveFigures&) const = default;
};

}  // namespace haptrial::analysis::drilling
