#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/files/new_folder.h"
#include "core/deformable/body/skin.h"
#include "core/geometry/files/mesh_io.h"
#include "experiments/command/arguments.h"
#include "experiments/command/deform/deform_body.h"
#include "experiments/command/deform/deform_files.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

struct DeformSkinOptions {
  DeformInput input;
  std::string surface;
  std::vector<std::string> states;
  std::string out;
  double scale{1.0};
  int neighbours{5};
  std::string format{"ply"};
};

int deform_skin(const DeformSkinOptions& options) {
  namespace fs = std::filesystem;
  geometry::mesh_format("x." + options.format);
  const int neighbours = checked_number("--neighbours", options.neighbours, 1, 100);
  const DeformBody body = load_deform_body(options.input);
  geometry::Mesh surface = load_mesh({options.surface, options.scale, options.input.max_memory},
                                     MemoryBudget(options.input.max_memory));
  const auto parts = deformable::mesh_parts(body.mesh.tetrahedra);
  deformable::Skin skin(body.mesh.vertices, parts.surface, surface.vertices, neighbours);
  exchange::NewFolder out(options.out);
  Progress progress("skin", static_cast<double>(options.states.size()));
  watch_for_interrupt();
  double done = 0.0;
  std::size_t lost = 0;
  for (const std::string& state : options.states) {
    const auto moved = moved_by(body.mesh, read_displacements(state, body.mesh));
    std::vector<Eigen::Vector3d> places(surface.vertices.size());
    skin.update(moved, places);
    lost = std::max(lost, skin.lost_frames());
    geometry::Mesh posed = surface;
    posed.vertices.assign(places.begin(), places.end());
    const auto name = fs::path(state).stem().string() + "." + options.format;
    geometry::write_mesh(out.place(name), posed);
    progress.update(++done, name, 0.0);
    check_interrupt();
  }
  out.publish();
  fmt::print("skin        {} vertices by {} neighbours each, {} states\n", skin.vertices(),
             skin.neighbours(), options.states.size());
  if (lost > 0) {
    fmt::print("frames      up to {} had no direction and stayed as they were\n", lost);
  }
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_deform_skin(CLI::App& deform, int& status) {
  CLI::App* sub =
      subcommand(deform, "skin", "Move a fine surface with a body",
                 "haptrial deform skin gear.toml gear.ply out/reference/twist.csv --out out/skin",
                 {"a mesh for each state in the folder of --out", "guide-deformable.md"});
  auto& o = options_of<DeformSkinOptions>(*sub, status, deform_skin);
  add_deform_input(*sub, o.input);
  sub->add_option("SURFACE", o.surface, "Surface (.obj, .ply, .stl)")->required();
  sub->add_option("STATES", o.states, "Displacements of the body's vertices (.csv)")->required();
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--scale", o.scale,
                  with_default("Length of one unit of the surface [m]", o.scale));
  sub->add_option(
      "--neighbours", o.neighbours,
      with_default("Number of vertices of the body that place one of the surface", o.neighbours));
  sub->add_option("--format", o.format,
                  with_default("Format of the meshes: ply, obj or stl", o.format));
}

}  // namespace haptrial::experiments
