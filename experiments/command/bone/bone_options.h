#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/bone/data/load_bone.h"
#include "core/bone/model/bone_model.h"
#include "experiments/command/mesh_command.h"

namespace CLI {
class App;
}

namespace haptrial::experiments {

// Options that several subcommands of haptrial bone have.

/// A bone that is read, or a volume that becomes one.
struct BoneInput {
  std::string in;
  std::string as{"auto"};
  std::optional<double> spacing;  // [mm]
  std::string threshold;
  std::optional<double> dense;
  std::string labels;
  std::vector<std::string> without;
  bool mirror{false};
  std::optional<double> max_memory;  // [GB]
};
void add_bone_input(CLI::App& sub, BoneInput& o);

/// A part of a volume.
struct BoneBox {
  std::vector<double> crop;    // [mm]
  std::vector<double> around;  // [mm]
};
void add_bone_box(CLI::App& sub, BoneBox& o);
/// The box of --crop or --around, in B. @throws InputError
std::optional<Eigen::AlignedBox3d> chosen_box(const BoneBox& options);

/// A bone that is written.
struct BoneOutput {
  std::string out;
  bool overwrite{false};
};
void add_bone_output(CLI::App& sub, BoneOutput& o);

/// @throws InputError where OUT is no .nrrd, or is there and not to be overwritten.
void check_new_bone(const BoneOutput& options);

/// Options of --as, --spacing, --threshold, --dense, --labels, --without and --mirror.
/// @param budget  outlives the options
/// @throws InputError
bone::LoadOptions load_options(const BoneInput& options, const MemoryBudget& budget);

/// A bone's grid, side and structures, on standard output.
void print_bone(const bone::BoneModel& model);
/// Warnings about a bone: names that say nothing to the program, what was lost of its files or
/// assumed, and what cannot be told of such a bone.
void print_warnings(const bone::BoneModel& model);

void save_new_bone(const BoneOutput& options, const bone::BoneModel& model);

}  // namespace haptrial::experiments
