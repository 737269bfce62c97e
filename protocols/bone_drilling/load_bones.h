#pragma once

#include <filesystem>

#include "core/bone/model/bone_model.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// Makes or reads the bones of a definition, and what is made once from each; takes seconds.
/// @param folder  of the file
/// @throws InputError as bone::load_bone() and bone_in_session() do
void load_bones(BoneDefinition& definition, const std::filesystem::path& folder);

/// A definition with its bones.
/// @throws InputError with a sentence for every problem of the file; as load_bones() does
BoneDefinition load_bone_definition(const std::filesystem::path& file);

/// The bone itself as a stage has it now: voxels that hold nothing are empty, others keep what is
/// left of their density. Pieces that came off are put aside.
bone::BoneModel bone_left(const BoneStage& stage);

/// The bone of a recorded drilling as it stood at a time or at the beginning of a phase, to the
/// bit, by simulating the recording again up to there.
/// @throws InputError where the session does not have that procedure, time or phase, or its
/// recording does not lead to the same bone
bone::BoneModel bone_in_session(const std::filesystem::path& session,
                                const BoneBeginning& beginning);

}  // namespace haptrial::protocols
