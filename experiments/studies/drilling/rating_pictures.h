#pragma once

#include <filesystem>
#include <vector>

#include "core/render/gl/image.h"
#include "protocols/bone_drilling/bone_replay.h"

namespace haptrial::experiments {

/// A procedure on one sheet: `frames` pictures as the participant saw it at evenly spaced moments,
/// from left to right and from top to bottom, and below them the cavity at the end, from where the
/// procedure began to be seen. Nothing on it says who or when.
/// @param frames  > 1
/// @throws InputError for a trial that is not there.
render::Image frame_sheet(const protocols::BoneReplay& replay, int trial, int frames);

/// The same as a film: every procedure `speed` times as fast as it went, and at the end the cavity
/// for some seconds. @param file  new, .mp4
void film(const protocols::BoneReplay& replay, int trial, const std::filesystem::path& file,
          double speed);

/// Pictures of one size side by side, `columns` in a row, and one as wide as a row below them.
/// @throws std::invalid_argument where sizes differ or columns are fewer than one.
render::Image contact_sheet(const std::vector<render::Image>& frames, int columns,
                            const render::Image& below);

}  // namespace haptrial::experiments
