#pragma once

#include "core/bone/data/load_bone.h"
#include "core/bone/model/bone_model.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {

/// @throws InputError where OUT is no .nrrd, or is there and not to be overwritten.
void check_new_bone(const BoneOptions& options);

/// Options of --as, --spacing, --threshold, --dense, --labels, --without and --mirror.
/// @param budget  outlives the options
/// @throws InputError
bone::LoadOptions load_options(const BoneOptions& options, const MemoryBudget& budget);

/// A bone's grid, side and structures, on standard output.
void print_bone(const bone::BoneModel& model);
/// Names that say nothing to the program, and what it could not tell of such a bone.
void print_unknown(const bone::BoneModel& model);

void save_new_bone(const BoneOptions& options, const bone::BoneModel& model);

}  // namespace haptrial::experiments
