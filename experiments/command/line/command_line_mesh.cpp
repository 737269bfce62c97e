// Surface meshes.

#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {
namespace {

/// A subcommand that reads or writes meshes.
struct MeshCommand {
  CLI::App& sub;
  MeshOptions& o;

  void take_input() const {
    sub.add_option("IN", o.input.file, "Mesh (.obj, .ply, .stl)")->required();
    sub.add_option("--scale", o.input.scale, "Length of one unit of the file [m] (default: 1)");
    sub.add_option("--max-memory", o.input.max_memory,
                   "Limit of memory [GB]; a larger input is refused (default: the free memory)");
  }
  void take_output(const char* what) const { sub.add_option("OUT", o.out, what)->required(); }
  void take_resolution() const {
    sub.add_option("--resolution", o.voxels.resolution,
                   "Number of voxels along the longest axis (default: 100)");
  }
  void take_rule() const {
    sub.add_option("--inside", o.voxels.rule,
                   "Rule for inside voxels: auto, parity, winding or flood (default: auto)");
  }
  void take_voxels() const {
    take_resolution();
    sub.add_flag("--over", o.voxels.over, "Extend the solid one voxel beyond the surface");
    take_rule();
  }
  void take_picture(const char* what) const {
    sub.add_option("--picture", o.picture, what);
    sub.add_option("--up", o.up, "Axis that points up in the picture: x, y or z (default: y)");
  }
};

constexpr const char* kNewMesh = "New mesh (.obj, .ply, .stl)";
constexpr const char* kNewPicture = "New picture (.png)";

MeshCommand begin(CLI::App* sub, int& status, int (*command)(const MeshOptions&)) {
  auto& o = options_of<MeshOptions>(*sub, status, command);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing files");
  return {*sub, o};
}

void add_mesh_make(CLI::App& mesh, int& status) {
  const MeshCommand make =
      begin(subcommand(mesh, "make", "Make an example mesh", "haptrial mesh make gear gear.ply"),
            status, mesh_make);
  make.sub.add_option("SHAPE", make.o.shape, "Shape: sphere, torus, gear or rough")->required();
  make.take_output(kNewMesh);
}

void add_mesh_info(CLI::App& mesh, int& status) {
  const MeshCommand info = begin(
      subcommand(mesh, "info", "Describe a mesh and its defects", "haptrial mesh info gear.ply"),
      status, mesh_info);
  info.take_input();
  info.take_picture(kNewPicture);
}

void add_repair(CLI::App& mesh, int& status) {
  const MeshCommand repair =
      begin(subcommand(mesh, "repair", "Weld, clean and orient a mesh",
                       "haptrial mesh repair scan.stl clean.ply --weld 1e-5"),
            status, mesh_repair);
  repair.take_input();
  repair.take_output(kNewMesh);
  repair.sub.add_option("--weld", repair.o.weld,
                        "Distance within which vertices are merged [m] (default: 0)");
}

void add_voxelize(CLI::App& mesh, int& status) {
  const MeshCommand voxelize =
      begin(subcommand(mesh, "voxelize", "Label the voxels of a grid as inside or outside",
                       "haptrial mesh voxelize gear.ply gear.nrrd --resolution 135"),
            status, mesh_voxelize);
  voxelize.take_input();
  voxelize.take_output("New volume (.nrrd, .h5)");
  voxelize.take_voxels();
  voxelize.take_picture(kNewPicture);
}

void add_distance(CLI::App& mesh, int& status) {
  const MeshCommand distance =
      begin(subcommand(mesh, "distance", "Compute the exact distance of every voxel to the surface",
                       "haptrial mesh distance gear.ply gear-distance.nrrd --everywhere"),
            status, mesh_distance);
  distance.take_input();
  distance.take_output("New volume of distances [m] (.nrrd, .h5)");
  distance.take_resolution();
  distance.take_rule();
  distance.sub.add_flag("--everywhere", distance.o.everywhere,
                        "Compute the positive distances outside, too");
  distance.sub.add_option("--margin", distance.o.voxels.margin,
                          "Number of extra voxels on every side (default: 0)");
  distance.sub.add_option("--points", distance.o.points,
                          "New volume of nearest points [m] (.nrrd, .h5)");
  distance.take_picture("New picture of the slice in the middle (.png)");
}

void add_tetrahedralize(CLI::App& mesh, int& status) {
  const MeshCommand split =
      begin(subcommand(mesh, "tetrahedralize", "Fill a mesh with tetrahedra, five to a voxel",
                       "haptrial mesh tetrahedralize gear.ply gear.vtu --resolution 40"),
            status, mesh_tetrahedralize);
  split.take_input();
  split.take_output("New mesh (.node with .ele, .vtu, .h5)");
  split.take_voxels();
  split.take_picture(kNewPicture);
}

}  // namespace

void add_mesh(CLI::App& app, int& status) {
  CLI::App* mesh =
      subcommand(app, "mesh", "Check, repair, voxelize, measure and split surface meshes",
                 "haptrial mesh tetrahedralize bunny.ply bunny.vtu", {"", "algorithms/meshes.md"});
  mesh->require_subcommand(1);
  add_mesh_make(*mesh, status);
  add_mesh_info(*mesh, status);
  add_repair(*mesh, status);
  add_voxelize(*mesh, status);
  add_distance(*mesh, status);
  add_tetrahedralize(*mesh, status);
}

}  // namespace haptrial::experiments
