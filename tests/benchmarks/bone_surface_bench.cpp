// Two ways to make the surface of a bone, compared: the source's, which joins neighbouring surface
// voxels, and ours, one vertex to a surface cell. bench_bone_surface BONE.nrrd [FOLDER]: figures,
// and pictures of both into FOLDER.

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "core/bone/data/load_bone.h"
#include "core/bone/surface/surface.h"
#include "core/geometry/volume/mesh_check.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/gl/offscreen.h"
#include "experiments/command/bone/bone_carving.h"
#include "tests/core/bone/surface/surface_checks.h"
#include "tests/support/references/neighbour_surface.h"

namespace {

using namespace haptrial;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

geometry::Mesh mesh_of(const bone::Surface& surface) {
  geometry::Mesh mesh;
  for (const bone::SurfaceVertex& vertex : surface.vertices()) {
    mesh.vertices.push_back(bone::place_of(vertex));
  }
  for (const bone::SurfaceTriangle& t : bone::living(surface.triangles())) {
    mesh.triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                              static_cast<std::int32_t>(t[2])});
  }
  return mesh;
}

/// Edges by how many triangles share them: not two; and not as often one way as the other.
void print(const char* name, const geometry::Mesh& mesh, double time, double voxels) {
  std::vector<bone::SurfaceTriangle> triangles;
  std::vector<bone::SurfaceVertex> vertices(mesh.vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      vertices[v].place[static_cast<std::size_t>(axis)] =
          static_cast<float>(mesh.vertices[v][axis]);
    }
  }
  for (const geometry::Triangle& t : mesh.triangles) {
    triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                         static_cast<std::uint32_t>(t[2])});
  }
  fmt::print(
      "{:10} {:9} vertices {:9} triangles {:8} edges not of two {:8} open  volume {:.3f} of "
      "the voxels'  {:7.0f} ms\n",
      name, vertices.size(), triangles.size(), bone::branching_edges(triangles),
      bone::open_edges(triangles), bone::enclosed_volume(vertices, triangles) / voxels, 1e3 * time);
}

void draw(const bone::BoneModel& model, geometry::Mesh mesh, const std::filesystem::path& file) {
  constexpr int kWidth = 1200;
  constexpr int kHeight = 900;
  render::OffscreenContext context(kWidth, kHeight);
  render::BoneScene scene(context.gl(), {}, model.structures, nullptr);
  render::BoneFrame frame;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  frame.camera = render::zoomed(
      render::looking_at(box, {-1.0, 0.2, 0.1}, Eigen::Vector3d::UnitZ(), 4.0 / 3.0), 2.2);
  frame.meshes.push_back({std::make_shared<geometry::Mesh>(std::move(mesh)),
                          Eigen::Isometry3d::Identity(),
                          {0.93, 0.88, 0.78}});
  scene.draw(frame, kWidth, kHeight);
  render::write_png(file, render::coarser(context.read(), 2));
}

/// A burr of 6 mm goes 12 mm along the surface in 60 steps.
void time_updates(const char* name, const bone::BoneModel& model, const Eigen::Vector3d& begin) {
  bone::BoneVolume volume(model);
  bone::Surface surface;
  surface.update(volume);
  const std::size_t triangles = surface.triangle_count();
  std::vector<double> times;
  for (int step = 0; step < 60; ++step) {
    const Eigen::Vector3d at = begin + 0.0002 * step * Eigen::Vector3d::UnitY();
    experiments::carve(volume, experiments::Stroke{at, at, 0.003}, {});
    const double start = seconds();
    surface.update(volume);
    times.push_back(seconds() - start);
  }
  const double start = seconds();
  surface.update(volume);
  const double idle = seconds() - start;
  std::sort(times.begin() + 1, times.end());
  fmt::print(
      "{:10} {:9} triangles  update: median {:.3f} ms, worst {:.3f} ms after the first; "
      "nothing changed {:.4f} ms\n",
      name, triangles, 1e3 * times[30], 1e3 * times.back(), 1e3 * idle);
}

/// The part of a model within 15 mm of a point.
bone::BoneModel part_of(bone::BoneModel model, const Eigen::Vector3d& middle) {
  const geometry::VoxelGrid& grid = model.grid;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if ((grid.centre(i, j, k) - middle).norm() > 0.015) {
          model.labels[grid.index(i, j, k)] = 0;
          if (!model.density.empty()) {
            model.density[grid.index(i, j, k)] = 0.0F;
          }
        }
      }
    }
  }
  return model;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print("bench_bone_surface BONE.nrrd [FOLDER]\n");
    return 2;
  }
  const bone::BoneModel model = bone::load_bone(argv[1]);
  const bone::BoneVolume volume(model);
  bone::Occupancy occupancy;
  std::vector<bone::Voxel> filled;
  occupancy.follow(volume, filled);
  const double voxels = static_cast<double>(filled.size()) * std::pow(model.grid.spacing, 3);
  fmt::print("{} voxels of {:.3g} mm\n", filled.size(), 1e3 * model.grid.spacing);

  double start = seconds();
  const bone::NeighbourSurface theirs(volume);
  print("neighbours", theirs.mesh(), seconds() - start, voxels);
  start = seconds();
  bone::Surface surface;
  surface.update(volume);
  const double time = seconds() - start;
  const geometry::Mesh ours = mesh_of(surface);
  print("cells", ours, time, voxels);
  // The picture is seen from the vertex that is farthest to the right of the patient.
  const auto side = std::min_element(ours.vertices.begin(), ours.vertices.end(),
                                     [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const Eigen::Vector3d middle = *side + Eigen::Vector3d(0.001, 0.0, 0.0);
  const Eigen::Vector3d begin = middle - Eigen::Vector3d(0.0, 0.006, 0.0);
  time_updates("whole", model, begin);
  time_updates("part", part_of(model, middle), begin);
  if (argc > 2) {
    const std::filesystem::path folder = argv[2];
    draw(model, theirs.mesh(), folder / "bone-surface-neighbours.png");
    draw(model, ours, folder / "bone-surface-cells.png");
  }
  return 0;
}
