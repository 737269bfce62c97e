#pragma once

#include <filesystem>

#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// Makes or reads the bones of a definition, and what is made once from each; takes seconds.
/// @param folder  of the file
/// @throws InputError as bone::load_bone() and bone_in_session() do
void load_bones(BoneDefinition& definition, const std::filesystem::path& folder);

/// A definition with its bones.
/// @throws InputError with a sentence for every problem of the file; as load_bones() does
BoneDefinition load_bone_definition(const std::filesystem::path& file);

}  // namespace haptrial::protocols
