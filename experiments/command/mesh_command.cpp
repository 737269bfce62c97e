#include "experiments/command/mesh_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/geometry/files/mesh_io.h"
#include "core/render/gl/image.h"
#include "experiments/command/arguments.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr double kGigabyte = 1e9;

/// Memory that Linux could give without swapping; infinite if it does not say.
double available_memory() {
  std::ifstream info("/proc/meminfo");
  std::string key;
  double kilobytes = 0.0;
  for (std::string rest; info >> key >> kilobytes && std::getline(info, rest);) {
    if (key == "MemAvailable:") {
      return 1024.0 * kilobytes;
    }
  }
  return INFINITY;
}

geometry::InsideRule rule_for(const geometry::Mesh& mesh, const std::string& name) {
  using geometry::InsideRule;
  if (name == "auto") {
    return geometry::fitting_rule(mesh);
  }
  for (const InsideRule rule : {InsideRule::kParity, InsideRule::kWinding, InsideRule::kFlood}) {
    if (name == name_of(rule)) {
      return rule;
    }
  }
  throw InputError(
      not_allowed("--inside", fmt::format("'{}'", name), {"auto", "parity", "winding", "flood"}));
}

}  // namespace

MemoryBudget::MemoryBudget(std::optional<double> gigabytes)
    : bytes_(gigabytes ? kGigabyte * *gigabytes : available_memory()), asked_(gigabytes) {
  if (!(bytes_ > 0.0)) {
    throw InputError(
        fmt::format("--max-memory is {}; allowed: a number above 0 [GB]", gigabytes.value_or(0.0)));
  }
}

void MemoryBudget::check(const std::string& what, double bytes) const {
  if (bytes > bytes_) {
    throw InputError(
        fmt::format("{} may take {:.3g} GB of memory; {} {:.3g} GB", what, bytes / kGigabyte,
                    asked_ ? "--max-memory allows" : "the system has", bytes_ / kGigabyte));
  }
}

ShownWork::ShownWork(const std::string& what) : progress_(what, 1.0) {}

geometry::WorkReport ShownWork::report() {
  return [this](double share) {
    progress_.update(share, "", 0.0);
    return !interrupted();
  };
}

geometry::Mesh load_mesh(const MeshInput& input, const MemoryBudget& budget) {
  if (!(input.scale > 0.0) || !std::isfinite(input.scale)) {
    throw InputError(fmt::format("--scale is {}; allowed: a number above 0", input.scale));
  }
  const geometry::MeshFormat format = geometry::mesh_format(input.file);
  std::error_code unknown;
  const auto size = fs::file_size(input.file, unknown);
  if (!unknown) {
    const auto bytes = size + geometry::reading_memory(size, format);
    budget.check(input.file, static_cast<double>(bytes));
  }
  ShownWork work("reading");
  geometry::Mesh mesh = geometry::read_mesh(input.file, work.report());
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex *= input.scale;
  }
  return mesh;
}

const char* name_of(geometry::InsideRule rule) {
  switch (rule) {
    case geometry::InsideRule::kParity:
      return "parity";
    case geometry::InsideRule::kWinding:
      return "winding";
    case geometry::InsideRule::kFlood:
      break;
  }
  return "flood";
}

VoxelizedMesh voxelize_mesh(const geometry::Mesh& mesh, const VoxelizeOptions& options,
                            const MemoryBudget& budget) {
  const geometry::InsideRule rule = rule_for(mesh, options.rule);
  const geometry::VoxelGrid grid =
      geometry::make_grid(geometry::bounds(mesh), options.resolution,
                          options.over ? std::max(options.margin, 1) : options.margin);
  budget.check(
      fmt::format("a grid of {} x {} x {} voxels", grid.size[0], grid.size[1], grid.size[2]),
      geometry::voxelizing_memory(mesh, grid, rule));
  ShownWork work("voxelizing");
  const auto start = std::chrono::steady_clock::now();
  VoxelizedMesh result{geometry::voxelize(mesh, grid, rule, work.report()), rule, 0.0};
  if (options.over) {
    geometry::grow(result.solid);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void write_picture(const std::string& file, std::span<const render::SceneTriangle> scene,
                   const render::SceneView& view, bool overwrite) {
  check_new(file, overwrite);
  if (scene.empty()) {
    throw InputError(fmt::format("{}: there is nothing to draw", file));
  }
  render::write_png(file, render::draw_scene(scene, view));
}

render::SceneView view_with_up(const std::string& up) {
  render::SceneView view;
  if (up.size() != 1 || up[0] < 'x' || up[0] > 'z') {
    throw InputError(fmt::format("--up is '{}'; allowed: x, y, z", up));
  }
  view.up = Eigen::Vector3d::Unit(up[0] - 'x');
  return view;
}

}  // namespace haptrial::experiments
