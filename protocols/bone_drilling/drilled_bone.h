#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "protocols/bone_drilling/bone_replay.h"

namespace haptrial::protocols {

/// Part of one structure that a procedure removed.
struct RemovedPart {
  std::string structure;
  std::size_t voxels{0};
  bool vital{false};
};

/// A bone after all that a session file has of it.
struct DrilledBone {
  std::shared_ptr<BoneStage> stage;  // with the bone itself and every piece of it
  /// The bone before the procedure, but that voxels which hold nothing any more have labels of
  /// their own: "removed" for plain bone, "removed NAME" for other structures. Without densities.
  bone::BoneModel marked;
  std::vector<RemovedPart> removed;  // by label of the bone
  ReplayVerdict verdict;
};

/// Repeats a trial as BoneReplay::run() does, its last bone where there were several. Voxels that
/// lost a part of their density only count as left, and so does what was cut off in pieces.
/// @throws InputError for a trial that is not there, a recording that does not lead to the same
/// bone, or a bone without labels left for what was removed.
DrilledBone drilled_bone(const BoneReplay& replay, int trial, const BoneReplay::Pulse& pulse = {});

}  // namespace haptrial::protocols
