// The source's study of its distance maps, repeated: computation against resolution, the height of
// the seed above the last winner, and depth against breadth first.
//
//   bench_distance_study [FOLDER [MESH...]]
//
// With a FOLDER the series behind the figures of docs/algorithms/distance-maps.md are written
// there. Counts are the same on every machine; seconds are this thread's processor time. Source:
// Morris 2006, §6.3.4.

#include <fmt/core.h>
#include <fmt/os.h>
#include <time.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/distance_map.h"
#include "core/geometry/volume/voxelize.h"
#include "tests/support/references/source_distance.h"

namespace {

using namespace haptrial::geometry;
using Options = SourceDistance::Options;

double processor_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Subject {
  std::string name;
  Mesh mesh;
};

/// The centres of the inside voxels in raster order.
std::vector<Eigen::Vector3d> inside_centres(const VoxelSolid& solid) {
  std::vector<Eigen::Vector3d> centres;
  const auto& size = solid.grid.size;
  for (std::int32_t k = 0; k < size[2]; ++k) {
    for (std::int32_t j = 0; j < size[1]; ++j) {
      for (std::int32_t i = 0; i < size[0]; ++i) {
        if (solid.labels[solid.grid.index(i, j, k)] == VoxelLabel::kInside) {
          centres.push_back(solid.grid.centre(i, j, k));
        }
      }
    }
  }
  return centres;
}

struct Cost {
  double seconds;
  double per_voxel;  // boxes and triangles
};

Cost cost_of(SourceDistance& source, const Options& options,
             const std::vector<Eigen::Vector3d>& points) {
  source.start(options);
  const double start = processor_seconds();
  for (const Eigen::Vector3d& point : points) {
    source.closest(point);
  }
  const double seconds = processor_seconds() - start;
  const double tests = static_cast<double>(source.counts().boxes + source.counts().triangles);
  return {seconds, tests / static_cast<double>(points.size())};
}

/// A figure's series, one file of columns each.
class Series {
 public:
  Series(const std::string& folder, const std::string& name) {
    if (!folder.empty()) {
      file_.emplace(fmt::output_file(folder + "/" + name + ".dat"));
    }
  }
  template <class... Values>
  void row(const Values&... values) {
    if (file_) {
      (file_->print("{} ", values), ...), file_->print("\n");
    }
  }

 private:
  std::optional<fmt::ostream> file_;
};

/// Table 3 and Figure 53.
void resolutions(const std::vector<Subject>& subjects, const std::string& folder) {
  fmt::print("{:<12}{:>10}{:>6}{:>10}{:>14}{:>14}{:>12}{:>12}\n", "mesh", "triangles", "axis",
             "voxels", "voxelize [s]", "source [s]", "tests/voxel", "ours [s]");
  for (const Subject& subject : subjects) {
    Series series(folder, "resolution-" + subject.name);
    SourceDistance source(subject.mesh);
    const Bvh bvh(subject.mesh);
    for (const int resolution : {30, 75, 135, 195}) {
      const double start = processor_seconds();
      const VoxelSolid solid = voxelize(subject.mesh, make_grid(bounds(subject.mesh), resolution),
                                        fitting_rule(subject.mesh), {}, &bvh);
      const double voxelized = processor_seconds();
      const auto points = inside_centres(solid);
      const Cost cost = cost_of(source, {}, points);
      const double before = processor_seconds();
      make_distance_map(bvh, solid, {.threads = 1});
      const double ours = processor_seconds() - before;
      fmt::print("{:<12}{:>10}{:>6}{:>10}{:>14.3f}{:>14.3f}{:>12.1f}{:>12.4f}\n", subject.name,
                 subject.mesh.triangles.size(), resolution, points.size(), voxelized - start,
                 cost.seconds, cost.per_voxel, ours);
      series.row(resolution, points.size(), cost.seconds, cost.per_voxel, ours);
    }
  }
}

/// Figures 54, 55 and 56.
void seeds_and_orders(const Subject& subject, const std::string& folder) {
  fmt::print("\nboxes and triangles tested per voxel, {}\n{:>6}{:>14}", subject.name, "axis",
             "order");
  for (int ascend = -1; ascend <= 4; ++ascend) {
    fmt::print("{:>10}", fmt::format("N = {}", ascend));
  }
  fmt::print("\n");
  Series series(folder, "seeds-" + subject.name);
  SourceDistance source(subject.mesh);
  for (const int resolution : {30, 75, 135}) {
    const auto points = inside_centres(voxelize(
        subject.mesh, make_grid(bounds(subject.mesh), resolution), fitting_rule(subject.mesh)));
    for (const bool depth_first : {true, false}) {
      fmt::print("{:>6}{:>14}", resolution, depth_first ? "depth" : "breadth");
      for (int ascend = -1; ascend <= 4; ++ascend) {
        const Cost cost = cost_of(source, {ascend, depth_first}, points);
        fmt::print("{:>10.1f}", cost.per_voxel);
        series.row(resolution, depth_first ? "depth" : "breadth", ascend, cost.per_voxel,
                   cost.seconds);
      }
      fmt::print("\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "";
  std::vector<Subject> subjects;
  subjects.push_back({"gear", make_gear()});
  subjects.push_back({"rough", make_rough_solid(0.2, 28, 1)});
  for (int i = 2; i < argc; ++i) {
    subjects.push_back({std::filesystem::path(argv[i]).stem().string(), read_mesh(argv[i])});
  }
  resolutions(subjects, folder);
  for (const Subject& subject : subjects) {
    seeds_and_orders(subject, folder);
  }
}
