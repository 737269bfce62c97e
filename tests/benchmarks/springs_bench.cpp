// Forces of length, area and volume on 20,480 tetrahedra (16 x 16 x 16 cubes of five), and a step
// of Verlet's method with them, on one core. Beside it what published peers compute, lengths alone,
// edge after edge, so that figures of different machines can be compared. Times are processor time
// of this thread: the fastest and the median of many.
//
//     bench_springs

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "core/base/random.h"
#include "core/deformable/body/skin.h"
#include "core/deformable/springs/equilibrium.h"
#include "core/deformable/springs/spring_motion.h"
#include "core/deformable/springs/spring_tangent.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/support/solid_block.h"

namespace {

using namespace haptrial::deformable;
using Eigen::Vector3d;

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void measure(const std::string& what, int runs, const std::function<void()>& call) {
  std::vector<double> times;
  for (int run = 0; run < runs; ++run) {
    const double begin = now();
    call();
    times.push_back(1e6 * (now() - begin));
  }
  std::sort(times.begin(), times.end());
  fmt::print("{:40} fastest {:9.1f} us, median {:9.1f} us\n", what, times.front(),
             times[times.size() / 2]);
}

std::vector<Vector3d> shaken(const SpringBody& body, double by) {
  haptrial::RandomStream random(1, "shake");
  std::vector<Vector3d> positions = body.rest;
  for (Vector3d& p : positions) {
    p += by * Vector3d(random.normal(), random.normal(), random.normal());
  }
  return positions;
}

/// f = k / L₀² (l − L₀) along each edge: the law of the peers.
void add_lengths(const SpringBody& body, const std::vector<Vector3d>& at,
                 std::vector<Vector3d>& sums) {
  for (std::size_t e = 0; e < body.parts.edges.size(); ++e) {
    const auto [a, b] = body.parts.edges[e];
    const Vector3d way = at[b] - at[a];
    const double length = way.norm(), rest = body.lengths[e];
    const double stiffness = body.constants.length[e] / (rest * rest);
    const Vector3d force = stiffness * (length - rest) / length * way;
    sums[a] += force;
    sums[b] -= force;
  }
}

void measure_sets(const SpringBody& body) {
  const std::vector<Vector3d> positions = shaken(body, 3e-4);
  for (const haptrial::InstructionSet set : haptrial::available_instruction_sets()) {
    const SpringForces springs(body, set);
    PaddedPoints at = springs.points();
    for (std::size_t v = 0; v < positions.size(); ++v) {
      at[v] = positions[v];
    }
    PaddedPoints sums(at.size());
    measure(fmt::format("forces, {}", haptrial::name_of(set)), 2000,
            [&] { springs.add(at, sums); });
  }
}

/// Cubes of 1 cm whose centres are in a ball of `radius` cubes.
haptrial::geometry::TetMesh ball(double radius) {
  haptrial::geometry::VoxelSolid solid;
  const auto side = static_cast<std::int32_t>(2 * radius) + 2;
  solid.grid = {{side, side, side}, Vector3d::Constant(-0.005 * (side - 1)), 0.01};
  for (std::int32_t k = 0; k < side; ++k) {
    for (std::int32_t j = 0; j < side; ++j) {
      for (std::int32_t i = 0; i < side; ++i) {
        const Vector3d centre = Vector3d(i, j, k) - Vector3d::Constant(0.5 * (side - 1));
        solid.labels.push_back(centre.norm() < radius ? haptrial::geometry::VoxelLabel::kInside
                                                      : haptrial::geometry::VoxelLabel::kOutside);
      }
    }
  }
  return haptrial::geometry::tetrahedralize(solid);
}

void measure_skin() {
  const SpringBody body = spring_body(ball(8.6), 1000, {0.01, 0.01, 0.01});
  const haptrial::geometry::Mesh sphere = haptrial::geometry::make_sphere(0.086, 50);
  Skin skin(body.rest, body.parts.surface, sphere.vertices);
  std::vector<Vector3d> placed(sphere.vertices.size());
  fmt::print("{} tetrahedra, skin of {} triangles\n", body.tetrahedra.size(),
             sphere.triangles.size());
  const std::vector<Vector3d> positions = shaken(body, 3e-4);
  measure("skin", 500, [&] { skin.update(positions, placed); });
  SpringMotion motion(body, {0.5 * stable_step(body), 1e-3});
  measure("a step of this body", 2000, [&] { motion.step(); });
}

/// The block, held at its bottom and pushed aside at its top.
void measure_equilibrium(const SpringBody& body) {
  LoadCase load{"push", {}, {}};
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    const double z = body.rest[v].z();
    if (z < 1e-9) {
      load.holds.push_back({static_cast<std::int32_t>(v), {0, 0, 0}});
    }
    if (z > 0.16 - 1e-9) {
      load.forces.push_back({static_cast<std::int32_t>(v), {1e-3, 0, -1e-3}});
    }
  }
  Equilibrium found;
  measure("equilibrium by Newton", 1, [&] { found = equilibrium(body, load); });
  double way = 0;
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    way = std::max(way, (found.positions[v] - body.rest[v]).norm());
  }
  fmt::print("  {} iterations, outcome {}, largest displacement {:.4f} m\n", found.iterations,
             static_cast<int>(found.outcome), way);
}

}  // namespace

int main() {
  const SpringBody body =
      spring_body(haptrial::test::solid_block({16, 16, 16}, 0.01), 1000, {0.01, 0.01, 0.01});
  fmt::print("{} tetrahedra, {} edges, {} faces, {} vertices\n", body.tetrahedra.size(),
             body.parts.edges.size(), body.parts.faces.size(), body.rest.size());
  measure_sets(body);
  std::vector<Vector3d> forces;
  const std::vector<Vector3d> positions = shaken(body, 3e-4);
  std::vector<Vector3d> sums(positions.size(), Vector3d::Zero());
  measure("lengths alone, edge after edge", 2000, [&] { add_lengths(body, positions, sums); });
  measure("forces, spring after spring", 20, [&] { forces = spring_forces(body, positions); });
  measure("packing", 3, [&] { pack_springs(body); });
  double step = 0;
  measure("stable step", 3, [&] { step = stable_step(body); });
  SpringMotion motion(body, {0.9 * step, 1e-3});
  measure("a step of Verlet's method", 2000, [&] { motion.step(); });
  measure_skin();
  measure_equilibrium(body);
  return 0;
}
