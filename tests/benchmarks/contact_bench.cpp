// Contact rendering on a tessellated sphere and on scanned meshes: tool at 50 mm/s, 0.5 to 2 mm
// below the surface. Times of single ticks with 20 ns of clock in them. Where Embree is installed,
// one ray of it from each place of the proxy to the tool says how fast the machine is.
//
//     bench_contact [--rounds N] [--ticks N]   each tick counts with the fastest of N rounds (5)

#include <time.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/contact/contact_surface.h"
#include "core/contact/proxy.h"
#include "core/contact/rigid_tool.h"
#include "core/contact/signed_distance.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/benchmarks/distance_peers.h"

namespace {

using Eigen::Vector3d;
using haptrial::RandomStream;
using haptrial::contact::ContactSurface;
using haptrial::contact::Proxy;
using haptrial::geometry::Mesh;
using Path = std::vector<Vector3d>;

int rounds = 5;
int ticks = 20000;
constexpr double kStep = 5e-5;  // 50 mm/s at 1 kHz [m]

double now_ns() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

Path circle(double radius, double depth) {
  Path path;
  for (int i = 0; i < ticks; ++i) {
    const double a = i * kStep / 0.03;
    path.push_back((radius - depth) * Vector3d(0.8 * std::sin(a), 0.6 * std::sin(a), std::cos(a)));
  }
  return path;
}

/// Lines between points of the surface, each place taken to the nearest of the surface and set 0.5
/// to 2 mm below it.
Path over(const Mesh& mesh, const ContactSurface& surface) {
  RandomStream random(1, "path");
  const auto pick = [&] {
    const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
    return Vector3d((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
  };
  Path path;
  Vector3d from = pick();
  while (static_cast<int>(path.size()) < ticks) {
    const Vector3d to = pick();
    const int parts = std::max(1, static_cast<int>((to - from).norm() / kStep));
    for (int i = 0; i < parts && static_cast<int>(path.size()) < ticks; ++i) {
      const auto nearest = surface.bvh().closest(from + (to - from) * i / parts);
      const double depth = 0.00125 + 0.00075 * std::sin(3e-3 * static_cast<double>(path.size()));
      path.push_back(nearest.point - depth * surface.normal(surface.slot(nearest.triangle)));
    }
    from = to;
  }
  return path;
}

template <class Start, class Tick>
void measure(const char* name, std::size_t count, Start start, Tick tick) {
  std::vector<double> times(count, 1e18);
  for (int round = 0; round < rounds; ++round) {
    start();
    for (std::size_t i = 0; i < count; ++i) {
      const double begin = now_ns();
      tick(i);
      times[i] = std::min(times[i], now_ns() - begin);
    }
  }
  times.erase(times.begin(), times.begin() + std::min<std::ptrdiff_t>(100, times.size() / 2));
  std::sort(times.begin(), times.end());
  std::printf("%-34s median %8.0f   99 %% %8.0f   99.9 %% %8.0f   worst %8.0f ns\n", name,
              times[times.size() / 2], times[times.size() * 99 / 100],
              times[times.size() * 999 / 1000], times.back());
  std::fflush(stdout);
}

void follow(const char* name, const ContactSurface& surface, const Path& path, double radius,
            const Vector3d& start) {
  Proxy proxy(surface, {.radius = radius});
  std::size_t unsettled = 0;
  measure(
      name, path.size(),
      [&] {
        proxy.start(start);
        unsettled = 0;
      },
      [&](std::size_t i) { unsettled += !proxy.follow(path[i]).settled; });
  if (unsettled > 0) {
    std::printf("  (%zu of %zu ticks not settled)\n", unsettled, path.size());
  }
}

#ifdef HAPTRIAL_EMBREE
void rays(const Mesh& mesh, const ContactSurface& surface, const Path& path,
          const Vector3d& start) {
  const haptrial::bench::EmbreeTree tree(mesh);
  Proxy proxy(surface, {});
  proxy.start(start);
  Path from;
  for (const Vector3d& tool : path) {  // a little outside, so that the ray meets the surface
    const Vector3d at = proxy.follow(tool).position;
    from.push_back(at + 1e-6 * (at - tool).normalized());
  }
  std::size_t met = 0;
  measure(
      "  one ray of Embree, proxy to tool", path.size(), [&] { met = 0; },
      [&](std::size_t i) { met += tree.meets(from[i], path[i]) < 1.0; });
  std::printf("  (%zu of %zu rays met the surface)\n", met, path.size());
}
#else
void rays(const Mesh&, const ContactSurface&, const Path&, const Vector3d&) {}
#endif

/// A cube of 10 mm that turns at 1 rad/s while it is pressed 1 mm into the surface.
void press_cube(const Mesh& mesh, const ContactSurface& surface, const Path& path) {
  using namespace haptrial::contact;
  constexpr double kSide = 0.01;  // [m]
  const SignedDistance body(mesh, surface);
  RigidTool tool(points_on(haptrial::geometry::make_box(Vector3d::Constant(kSide)), kSide / 9), {});
  const auto hand = [&](std::size_t i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(1e-3 * i, Vector3d(0.6, 0.0, 0.8)));
    const auto nearest = surface.bvh().closest(path[i]);
    const Vector3d normal = surface.normal(surface.slot(nearest.triangle));
    pose.translation() = nearest.point + (0.5 * kSide - 0.001) * normal;
    return pose;
  };
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < path.size(); ++i) {
    poses.push_back(hand(i));
  }
  std::size_t touching = 0;
  measure(
      "  rigid cube", path.size(),
      [&] {
        tool.begin(poses.front());
        touching = 0;
      },
      [&](std::size_t i) { touching += tool.tick(body, poses[i], 1e-3).touching; });
  std::printf("  (%zu points, of which %.1f touch)\n", tool.points(),
              static_cast<double>(touching) / static_cast<double>(path.size()));
}

void scanned(const char* file) {
  const char* folder = std::getenv("HAPTRIAL_DATA");
  const auto path = std::filesystem::path(folder ? folder : "../shared/data") / "meshes" / file;
  if (!std::filesystem::exists(path)) {
    std::printf("%s is not there (HAPTRIAL_DATA)\n", file);
    return;
  }
  Mesh mesh = haptrial::geometry::read_mesh(path);
  const auto box = haptrial::geometry::bounds(mesh);
  for (Vector3d& v : mesh.vertices) {
    v = 0.1 / box.sizes().maxCoeff() * (v - box.center());
  }
  const ContactSurface surface(mesh);
  const Path way = over(mesh, surface);
  std::printf("%s, 0.1 m long\n", file);
  const Vector3d start = surface.bvh().closest(way.front()).point * 1.3;
  follow("  point", surface, way, 0.0, start);
  follow("  sphere of 1 mm", surface, way, 0.001, start);
  rays(mesh, surface, way, start);
  press_cube(mesh, surface, way);
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; i += 2) {
    (std::strcmp(argv[i], "--rounds") == 0 ? rounds : ticks) = std::atoi(argv[i + 1]);
  }
  for (const int frequency : {71, 100}) {
    const Mesh mesh = haptrial::geometry::make_sphere(0.03, frequency);
    const ContactSurface surface(mesh);
    std::printf("sphere of 30 mm, %zu triangles\n", surface.triangles());
    follow("  point, 1 mm deep", surface, circle(0.03, 0.001), 0.0, {0, 0, 0.04});
    follow("  sphere of 1 mm, 1 mm deep", surface, circle(0.031, 0.001), 0.001, {0, 0, 0.04});
    follow("  point, no contact, 1 mm off", surface, circle(0.031, 0.0), 0.0, {0, 0, 0.04});
    rays(mesh, surface, circle(0.03, 0.001), {0, 0, 0.04});
  }
  scanned("bunny_watertight_29k_fcpw.obj");
  scanned("dragon_watertight_100k_fcpw.obj");
}
