// Nearest points of a mesh: ours beside CGAL's AABB tree and Embree's point query, one run, one
// table, one thread.
//
//   bench_distance [MESH [RESOLUTION]]     or HAPTRIAL_MESH; without one a rough solid is made
//
// The points are the centres of the voxels inside the mesh, in raster order and shuffled. Warm: a
// search starts from the answer before it, in the way that its library offers. Every way answers
// all points in turn, round after round; figures are medians over the rounds of the thread's own
// processor time. Distances are compared with ours, which are exact to the rounding of doubles.

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/bvh/bvh.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/distance_map.h"
#include "core/geometry/volume/voxelize.h"
#include "tests/benchmarks/distance_peers.h"

namespace {

using namespace haptrial::geometry;
using haptrial::RandomStream;
using Points = std::vector<Eigen::Vector3d>;

double processor_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

/// One way of answering all points: what it is called, and the squared distances that it gives.
struct SearchMethod {
  std::string name;
  std::function<void(const Points&, std::vector<double>&)> answer;
  std::vector<double> seconds{};
  double worst{0.0};  // difference of a distance from ours [m]
};

SearchMethod ours_many(const Bvh& bvh) {
  return {"ours, many at once", [&](const Points& points, std::vector<double>& squared) {
            std::vector<ClosestPoint> answers(points.size());
            bvh.closest(points, answers);
            for (std::size_t i = 0; i < points.size(); ++i) {
              squared[i] = answers[i].distance_squared;
            }
          }};
}
SearchMethod ours_one(const Bvh& bvh) {
  return {"ours, one by one", [&](const Points& points, std::vector<double>& squared) {
            for (std::size_t i = 0; i < points.size(); ++i) {
              squared[i] = bvh.closest(points[i]).distance_squared;
            }
          }};
}
SearchMethod ours_warm(const Bvh& bvh) {
  return {"ours, one by one, warm", [&](const Points& points, std::vector<double>& squared) {
            std::int32_t hint = -1;
            for (std::size_t i = 0; i < points.size(); ++i) {
              const ClosestPoint found = bvh.closest(points[i], hint);
              squared[i] = found.distance_squared;
              hint = found.triangle;
            }
          }};
}
/// The map of the whole grid, its arrays included.
SearchMethod ours_map(const Bvh& bvh, const VoxelSolid& solid) {
  return {"ours, distance map", [&](const Points&, std::vector<double>& squared) {
            const DistanceMap map = make_distance_map(bvh, solid, {.threads = 1});
            std::size_t i = 0;
            for (const double distance : map.distance) {
              if (!std::isnan(distance)) {
                squared[i++] = distance * distance;
              }
            }
          }};
}
template <class Peer>
SearchMethod of(const std::string& name, const Peer& peer, bool warm) {
  return {name + (warm ? ", warm" : ""),
          [&peer, warm](const Points& points, std::vector<double>& squared) {
            peer.answer(points, warm, squared);
          }};
}

void compare(const std::string& title, const Points& points, std::vector<SearchMethod> methods,
             int rounds) {
  std::vector<double> ours(points.size()), squared(points.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const double start = processor_seconds();
      methods[i].answer(points, i == 0 ? ours : squared);
      methods[i].seconds.push_back(processor_seconds() - start);
      for (std::size_t k = 0; i > 0 && k < points.size(); ++k) {
        methods[i].worst =
            std::max(methods[i].worst, std::abs(std::sqrt(squared[k]) - std::sqrt(ours[k])));
      }
    }
  }
  fmt::print("\n{:<34}{:>10}{:>12}{:>12}{:>16}\n", title, "seconds", "us/query", "x ours",
             "worst error [m]");
  for (const SearchMethod& way : methods) {
    const double seconds = median(way.seconds);
    fmt::print("{:<34}{:>10.4f}{:>12.4f}{:>12.2f}{:>16.1e}\n", way.name, seconds,
               1e6 * seconds / static_cast<double>(points.size()),
               seconds / median(methods[0].seconds), way.worst);
  }
}

template <class Build>
double build_time(Build build) {
  std::vector<double> seconds;
  for (int i = 0; i < 5; ++i) {
    const double start = processor_seconds();
    build();
    seconds.push_back(processor_seconds() - start);
  }
  return median(seconds);
}

void print_build(const char* name, double seconds, double ours) {
  fmt::print("{:<34}{:>10.1f}{:>12.2f}\n", name, 1e3 * seconds, seconds / ours);
}

Points inside_points(const VoxelSolid& solid) {
  Points points;
  const auto& size = solid.grid.size;
  for (std::int32_t k = 0; k < size[2]; ++k) {
    for (std::int32_t j = 0; j < size[1]; ++j) {
      for (std::int32_t i = 0; i < size[0]; ++i) {
        if (solid.labels[solid.grid.index(i, j, k)] == VoxelLabel::kInside) {
          points.push_back(solid.grid.centre(i, j, k));
        }
      }
    }
  }
  return points;
}

}  // namespace

int main(int argc, char** argv) {
  const char* file = argc > 1 ? argv[1] : std::getenv("HAPTRIAL_MESH");
  const int resolution = argc > 2 ? std::atoi(argv[2]) : 135;
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 3;
  const Mesh mesh = file != nullptr ? read_mesh(file) : make_rough_solid(0.156, 59, 1);
  const BvhOptions one_thread{.threads = 1};
  fmt::print("{} triangles, {} along the longest axis, {}, kernels for {}\n", mesh.triangles.size(),
             resolution, file != nullptr ? "from a file" : "a rough solid",
             haptrial::name_of(one_thread.instruction_set));

  const double ours = build_time([&] { Bvh(mesh, one_thread); });
  fmt::print("\n{:<34}{:>10}{:>12}\n", "build", "ms", "x ours");
  print_build("ours", ours, ours);
  const Bvh bvh(mesh, one_thread);
#ifdef HAPTRIAL_EMBREE
  print_build("Embree", build_time([&] { haptrial::bench::EmbreeTree{mesh}; }), ours);
  const haptrial::bench::EmbreeTree embree(mesh);
#endif
#ifdef HAPTRIAL_CGAL
  print_build("CGAL", build_time([&] { haptrial::bench::CgalTree{mesh}; }), ours);
  const haptrial::bench::CgalTree cgal(mesh);
#endif

  const VoxelSolid solid = voxelize(mesh, make_grid(bounds(mesh), resolution), fitting_rule(mesh));
  Points points = inside_points(solid);
  std::vector<SearchMethod> shuffled{ours_many(bvh), ours_one(bvh), ours_warm(bvh)};
  std::vector<SearchMethod> raster{ours_map(bvh, solid)};
  raster.insert(raster.end(), shuffled.begin(), shuffled.end());
#ifdef HAPTRIAL_EMBREE
  raster.push_back(of("Embree", embree, false));
  raster.push_back(of("Embree", embree, true));
  shuffled.push_back(of("Embree", embree, false));
  shuffled.push_back(of("Embree", embree, true));
#endif
#ifdef HAPTRIAL_CGAL
  raster.push_back(of("CGAL", cgal, false));
  raster.push_back(of("CGAL", cgal, true));
  shuffled.push_back(of("CGAL", cgal, false));
  shuffled.push_back(of("CGAL", cgal, true));
#endif
  compare(fmt::format("{} points, raster order", points.size()), points, raster, rounds);
  RandomStream random(1, "shuffle");
  for (std::size_t i = points.size(); i > 1; --i) {
    std::swap(points[i - 1], points[random.below(i)]);
  }
  constexpr std::size_t kShuffled = 100000;  // a misleading start costs some peers seconds
  points.resize(std::min(points.size(), kShuffled));
  compare(fmt::format("{} points, shuffled", points.size()), points, shuffled, rounds);
}
