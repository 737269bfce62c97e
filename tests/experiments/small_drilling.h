#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::test {

/// The shipped definition of drillings with lines of it replaced, each given by how it starts:
/// {"time_limit", "time_limit = 5.0"}.
/// @throws std::invalid_argument where there is no such line.
std::string drilling_with(const std::vector<std::pair<std::string, std::string>>& lines);

/// Two slabs of bone, one over the other, held together by four posts of which a virtual hand
/// drills through: 32 x 12 x 20 voxels of 1 mm. A nerve runs in the lower one.
bone::BoneModel two_slabs();
/// The same with the upper slab of bone over dura.
bone::BoneModel slabs_over_dura();

/// A folder with that bone (slabs.nrrd) and a definition (study.toml) of so many seconds on it.
/// @param more  lines to replace
std::filesystem::path write_small_drilling(
    const std::filesystem::path& folder, double seconds,
    const std::vector<std::pair<std::string, std::string>>& more = {});

}  // namespace haptrial::test
