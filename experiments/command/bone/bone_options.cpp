#include "experiments/command/bone/bone_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/bone_file.h"
#include "core/bone/data/bone_summary.h"
#include "core/bone/data/ear_side.h"
#include "experiments/command/arguments.h"
#include "experiments/command/bone/bone_carving.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

bone::VolumeKind kind_of(const std::string& name) {
  if (name == "auto") {
    return bone::VolumeKind::kAuto;
  }
  if (name == "labels") {
    return bone::VolumeKind::kLabels;
  }
  if (name == "grey") {
    return bone::VolumeKind::kGrey;
  }
  throw InputError(not_allowed("--as", fmt::format("'{}'", name), {"auto", "labels", "grey"}));
}

std::string in_millimetres(const Eigen::Vector3d& place) {
  return fmt::format("{:.1f} {:.1f} {:.1f}", place.x() / kMillimetre, place.y() / kMillimetre,
                     place.z() / kMillimetre);
}

}  // namespace

void add_bone_input(CLI::App& sub, BoneInput& o) {
  sub.add_option("IN", o.in,
                 "Bone, volume or segmentation (.nrrd, .nhdr, .nii, .nii.gz), or folder with a "
                 "DICOM series")
      ->required();
  sub.add_option("--as", o.as, with_default("Kind of values: auto, labels or grey", o.as));
  sub.add_option(
      "--spacing", o.spacing,
      "Edge of a voxel [mm] (default: 0.5 for grey volumes, that of the file for labels)");
  sub.add_option("--threshold", o.threshold,
                 "Lowest value of bone, or auto (default: 300 in Hounsfield units)");
  sub.add_option("--dense", o.dense,
                 "Lowest value of fully dense bone (default: 1500 in Hounsfield units)");
  sub.add_option("--labels", o.labels, "Names of labels (.toml)");
  sub.add_option("--without", o.without, "Structures to leave out: NAME,NAME")->delimiter(',');
  sub.add_flag("--mirror", o.mirror, "Exchange left and right: a left ear becomes a right one");
  sub.add_option("--max-memory", o.max_memory, kMemoryHelp);
}

void add_bone_box(CLI::App& sub, BoneBox& o) {
  sub.add_option("--crop", o.crop, "Box to keep: X0,X1,Y0,Y1,Z0,Z1 [mm], as info prints places")
      ->delimiter(',');
  sub.add_option("--around", o.around, "Cube to keep about a point: X,Y,Z,EDGE [mm]")
      ->delimiter(',');
}

std::optional<Eigen::AlignedBox3d> chosen_box(const BoneBox& options) {
  const auto finite = [](const std::vector<double>& numbers) {
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                             static_cast<Eigen::Index>(numbers.size()))
        .allFinite();
  };
  const std::vector<double>& crop = options.crop;
  const std::vector<double>& around = options.around;
  if (crop.empty() && around.empty()) {
    return std::nullopt;
  }
  if (!crop.empty() && !around.empty()) {
    throw InputError("--crop and --around both choose a part; write one of them");
  }
  if (!around.empty()) {
    if (around.size() != 4 || !finite(around) || !(around[3] > 0.0)) {
      throw InputError("--around is not a place and an edge; allowed: X,Y,Z,EDGE [mm]");
    }
    const Eigen::Vector3d middle = kMillimetre * Eigen::Vector3d(around[0], around[1], around[2]);
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * kMillimetre * around[3]);
    return Eigen::AlignedBox3d(middle - half, middle + half);
  }
  const bool six = crop.size() == 6 && finite(crop);
  if (!six || !(crop[0] < crop[1] && crop[2] < crop[3] && crop[4] < crop[5])) {
    throw InputError("--crop is not a box; allowed: X0,X1,Y0,Y1,Z0,Z1 [mm], the lower first");
  }
  return Eigen::AlignedBox3d(kMillimetre * Eigen::Vector3d(crop[0], crop[2], crop[4]),
                             kMillimetre * Eigen::Vector3d(crop[1], crop[3], crop[5]));
}

void add_bone_output(CLI::App& sub, BoneOutput& o) {
  sub.add_option("OUT", o.out, "New bone (.nrrd)")->required();
  sub.add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

void check_new_bone(const BoneOutput& options) {
  const std::filesystem::path out = options.out;
  if (out.extension() != ".nrrd") {
    throw InputError(
        fmt::format("{}: ends in '{}'; allowed: .nrrd", options.out, out.extension().string()));
  }
  check_new(options.out, options.overwrite);
}

bone::LoadOptions load_options(const BoneInput& options, const MemoryBudget& budget) {
  bone::LoadOptions load;
  load.kind = kind_of(options.as);
  if (options.spacing) {
    load.spacing = *options.spacing * kMillimetre;
  }
  load.find_threshold = options.threshold == "auto";
  if (!options.threshold.empty() && !load.find_threshold) {
    std::size_t used = 0;
    try {
      load.threshold = std::stod(options.threshold, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != options.threshold.size() || !std::isfinite(*load.threshold)) {
      throw InputError(
          fmt::format("--threshold is '{}'; allowed: a number, or auto", options.threshold));
    }
  }
  load.dense = options.dense;
  load.label_file = options.labels;
  load.without = options.without;
  load.mirror = options.mirror;
  load.room = [&budget](const std::string& what, double bytes) { budget.check(what, bytes); };
  return load;
}

void print_bone(const bone::BoneModel& model) {
  const bone::BoneSummary summary = bone::summary_of(model);
  const geometry::VoxelGrid& grid = model.grid;
  fmt::print("bone        {}\n", model.name);
  fmt::print("source      {}\n", model.source);
  fmt::print("grid        {} x {} x {} voxels of {:.6g} mm, the first at {} mm\n", grid.size[0],
             grid.size[1], grid.size[2], grid.spacing / kMillimetre, in_millimetres(grid.origin));
  fmt::print("axes        x to the left, y to the back, z up\n");
  if (const auto side = bone::ear_side(model)) {
    fmt::print("side        a {} ear, by its structures\n",
               *side == bone::EarSide::kLeft ? "left" : "right");
  }
  fmt::print("box         {} to {} mm\n", in_millimetres(summary.box.min()),
             in_millimetres(summary.box.max()));
  fmt::print("surface     about {:.0f} mm2\n", 1e6 * summary.surface);
  fmt::print("{:5} {:28} {:>10} {:>11} {:>8} {:>7}  {}\n", "label", "structure", "voxels", "mm3",
             "density", "pieces", "vital");
  for (const bone::StructureSummary& one : summary.structures) {
    const bone::Structure& structure = model.structures[one.label];
    fmt::print("{:5} {:28} {:10} {:11.1f} {:8.2f} {:7}  {}\n", one.label, structure.name,
               one.voxels, 1e9 * one.volume, one.mean_density, one.pieces,
               structure.vital ? "yes" : "no");
  }
  fmt::print("{:5} {:28} {:10} {:11.1f}\n", "", "all", summary.voxels, 1e9 * summary.volume);
}

void print_warnings(const bone::BoneModel& model) {
  for (const bone::StructureSummary& one : bone::summary_of(model).structures) {
    const bone::Structure& structure = model.structures[one.label];
    if (!bone::is_known_structure(structure.name)) {
      fmt::print(
          "unknown     '{}' (label {}); the nearest known name is '{}': if it is that, say so "
          "in a file for --labels\n",
          structure.name, one.label, bone::nearest_structure(structure.name));
    }
  }
  if (!bone::has_vital_structures(model)) {
    fmt::print("WARNING: vital structures are unknown: no injury can be told in this bone\n");
  }
  for (const std::string& note : model.notes) {
    fmt::print("WARNING: {}\n", note);
  }
}

void save_new_bone(const BoneOutput& options, const bone::BoneModel& model) {
  bone::save_bone(options.out, model, options.overwrite);
  fmt::print("wrote       {}: {} x {} x {} voxels of {:.6g} mm\n", options.out, model.grid.size[0],
             model.grid.size[1], model.grid.size[2], model.grid.spacing / kMillimetre);
}

}  // namespace haptrial::experiments
