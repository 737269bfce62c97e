#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/display/bone_stage.h"

namespace haptrial::protocols {

/// A bone with which a session goes on that ended early.
struct RestoredBone {
  std::shared_ptr<BoneStage> stage;  // without companions and depths; null where there is none
  std::uint64_t ticks{0};            // of drilling that went into it
  std::string told;                  // what came of it, a sentence
};

/// Simulates again what is recorded of one bone, about 12 times as fast as it was drilled, so that
/// the bone is as it stood. It is not where the record cannot be read, or its simulation empties
/// other voxels or ends with another checksum, as it may with another version of the program.
/// @param session  that is gone on with, complete up to its end (SessionWriter::sync())
/// @param bone     `repetition` of its passes
/// @param pulse    as BoneReplay has it; what it throws goes through
RestoredBone restore_bone(const std::filesystem::path& session, int trial, std::int32_t bone,
                          const BoneReplay::Pulse& pulse = {});

}  // namespace haptrial::protocols
