#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/bone_file.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/surface/surface_mesh.h"
#include "core/geometry/files/mesh_io.h"
#include "experiments/command/arguments.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "protocols/bone_drilling/drilled_bone.h"

namespace haptrial::experiments {
namespace {

struct BoneExportOptions {
  std::string in;
  std::string out;
  std::optional<int> trial;
  std::string structure;
  bool ras{false};
  bool overwrite{false};
};

namespace fs = std::filesystem;

/// A bone that is exported: of a file as it is, or of a session as it was left.
struct Exported {
  bone::BoneModel model;
  std::optional<protocols::DrilledBone> drilled;
};

Exported load(const BoneExportOptions& options) {
  Exported exported;
  if (fs::path(options.in).extension() != ".h5") {
    if (options.trial) {
      throw InputError("--trial chooses a procedure of a session (.h5); leave it out for a bone");
    }
    ShownWork work("reading");
    exported.model = bone::load_bone(options.in, {}, work.report());
    return exported;
  }
  const protocols::BoneReplay replay(options.in);
  exported.drilled = protocols::drilled_bone(replay, options.trial.value_or(1), [](std::uint64_t) {
    if (interrupted()) {
      throw RunError("interrupted");
    }
  });
  exported.model = exported.drilled->marked;
  return exported;
}

void print_removed(const Exported& exported) {
  if (!exported.drilled) {
    return;
  }
  const double voxel = 1e9 * std::pow(exported.model.grid.spacing, 3);
  for (const protocols::RemovedPart& part : exported.drilled->removed) {
    fmt::print("removed     {}: {} voxels, {:.1f} mm3{}\n", part.structure, part.voxels,
               voxel * static_cast<double>(part.voxels), part.vital ? ", VITAL" : "");
  }
  if (exported.drilled->removed.empty()) {
    fmt::print("removed     nothing\n");
  }
}

/// The label of a structure that has voxels. @throws InputError
std::uint8_t label_of(const BoneExportOptions& options, const bone::BoneModel& model) {
  std::vector<bool> there(256, false);
  for (const std::uint8_t label : model.labels) {
    there[label] = true;
  }
  const std::string wanted = bone::structure_named(options.structure, 0).name;
  std::vector<std::string> known;
  for (std::size_t label = 1; label < model.structures.size(); ++label) {
    if (there[label] && model.structures[label].name == wanted) {
      return static_cast<std::uint8_t>(label);
    }
    if (there[label]) {
      known.push_back(model.structures[label].name);
    }
  }
  const std::string hint = did_you_mean(options.structure, known);
  throw InputError(fmt::format("{}: has no '{}'{} allowed: {}", options.in, options.structure,
                               hint.empty() ? ";" : hint, fmt::join(known, ", ")));
}

bool is_moved(const bone::BoneWorld& world, int piece) {
  return !world.pose(piece).isApprox(world.pose(0), 1e-9);
}

/// Every piece where it came to lie, in the frame of the bone itself.
geometry::Mesh mesh_of_pieces(const bone::BoneWorld& world) {
  geometry::Mesh all;
  for (int p = 0; p < world.pieces(); ++p) {
    const geometry::Mesh piece = bone::surface_mesh(world.volume(p));
    const Eigen::Isometry3d to_bone = world.pose(0).inverse() * world.pose(p);
    const auto first = static_cast<std::int32_t>(all.vertices.size());
    for (const Eigen::Vector3d& vertex : piece.vertices) {
      all.vertices.emplace_back(to_bone * vertex);
    }
    for (const geometry::Triangle& t : piece.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

/// Labels have one grid, which a piece that was moved has left.
void print_moved(const Exported& exported) {
  if (!exported.drilled) {
    return;
  }
  const auto& world = std::as_const(*exported.drilled->stage->simulator).world();
  int moved = 0;
  for (int p = 1; p < world.pieces(); ++p) {
    moved += world.volume(p).amount() > 0.0 && is_moved(world, p) ? 1 : 0;
  }
  if (moved > 0) {
    fmt::print("moved       {}; labels have them where they were cut, a mesh where they lie\n",
               counted(moved, "piece", "pieces"));
  }
}

geometry::Mesh mesh_of(const BoneExportOptions& options, const Exported& exported) {
  geometry::Mesh mesh;
  if (!options.structure.empty()) {
    mesh = bone::structure_mesh(exported.model, label_of(options, exported.model));
  } else if (exported.drilled) {
    mesh = mesh_of_pieces(std::as_const(*exported.drilled->stage->simulator).world());
  } else {
    mesh = bone::surface_mesh(bone::BoneVolume(exported.model));
  }
  const double sign = options.ras ? -1.0 : 1.0;
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = 1e3 * Eigen::Vector3d(sign * vertex.x(), sign * vertex.y(), vertex.z());
  }
  return mesh;
}

int bone_export(const BoneExportOptions& options) {
  const fs::path out = options.out;
  check_new(options.out, options.overwrite);
  const bool volume = out.extension() == ".nrrd";
  if (!volume) {
    geometry::mesh_format(out);
  }
  if (volume && !options.structure.empty()) {
    throw InputError("--structure is for meshes; leave it out for a volume (.nrrd)");
  }
  const Exported exported = load(options);
  print_removed(exported);
  if (volume) {
    print_moved(exported);
    bone::BoneModel labels = exported.model;
    labels.density.clear();
    bone::save_bone(out, labels, options.overwrite);
    fmt::print("wrote       {}: {} x {} x {} voxels of {:.6g} mm\n", options.out,
               labels.grid.size[0], labels.grid.size[1], labels.grid.size[2],
               1e3 * labels.grid.spacing);
    return 0;
  }
  const geometry::Mesh mesh = mesh_of(options, exported);
  geometry::write_mesh(out, mesh, options.overwrite);
  fmt::print("wrote       {}: {} triangles, {} in mm\n", options.out, mesh.triangles.size(),
             options.ras ? "RAS" : "LPS");
  return 0;
}

}  // namespace

void add_bone_export(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "export", "Write a bone, or what a session left of one, for other programs",
                 "haptrial bone export ear.nrrd ear.stl --structure 'facial nerve'",
                 {"the file OUT", "guide-scan.md"});
  auto& o = options_of<BoneExportOptions>(*sub, status, bone_export);
  sub->add_option("IN", o.in, "Bone (.nrrd) or session of bone drilling (.h5)")->required();
  sub->add_option("OUT", o.out, "New mesh (.stl, .obj, .ply) [mm] or labels (.seg.nrrd)")
      ->required();
  sub->add_option("--trial", o.trial, "Procedure of a session (default: 1)");
  sub->add_option("--structure", o.structure, "Structure of the mesh (default: the whole surface)");
  sub->add_flag("--ras", o.ras, "Write a mesh in RAS axes (default: LPS, as 3D Slicer reads them)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
