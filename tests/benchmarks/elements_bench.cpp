// Statics of a cube of cubes, five tetrahedra each: the bottom held, the top pushed aside.
//
//     bench_elements [--rounds N] [--law NAME] [--poisson NU] [--sides N ...]

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "core/deformable/elements/static_solver.h"
#include "tests/support/solid_block.h"

namespace {

using namespace haptrial::deformable;
using haptrial::geometry::TetMesh;

double now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

LoadCase push(const TetMesh& mesh, double force) {
  LoadCase load{"push", {}, {}};
  double top = 0;
  for (const auto& v : mesh.vertices) {
    top = std::max(top, v.z());
  }
  std::vector<std::int32_t> loaded;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (mesh.vertices[v].z() < 1e-9) {
      load.holds.push_back({vertex, {0, 0, 0}});
    }
    if (mesh.vertices[v].z() > top - 1e-9) {
      loaded.push_back(vertex);
    }
  }
  for (const std::int32_t v : loaded) {
    load.forces.push_back({v, {force / static_cast<double>(loaded.size()), 0, 0}});
  }
  return load;
}

struct Run {
  double seconds;
  StaticResult result;
};

Run best_of(int rounds, const TetMesh& mesh, const Elasticity& elasticity, const LoadCase& load,
            LinearSolver solver) {
  Run best{1e9, {}};
  for (int i = 0; i < rounds; ++i) {
    const double start = now();
    const ElasticBody body(mesh, elasticity);
    StaticResult result = solve_static(body, load, {.solver = solver});
    const double seconds = now() - start;
    if (seconds < best.seconds) {
      best = {seconds, std::move(result)};
    }
  }
  return best;
}

void time_assembly(int rounds, const TetMesh& mesh, const Elasticity& elasticity) {
  double body_s = 1e9, pattern_s = 1e9, stiffness_s = 1e9, forces_s = 1e9, multiply_s = 1e9;
  for (int i = 0; i < rounds; ++i) {
    double at = now();
    const auto lap = [&](double& best) {
      const double next = now();
      best = std::min(best, next - at);
      at = now();
    };
    const ElasticBody body(mesh, elasticity);
    lap(body_s);
    BlockMatrix matrix(body.patches().groups(), mesh.vertices.size());
    lap(pattern_s);
    Vectors u(mesh.vertices.size(), Eigen::Vector3d::Zero()), forces, product(u.size());
    at = now();
    body.stiffness(u, forces, matrix);
    lap(stiffness_s);
    body.forces(u, forces);
    lap(forces_s);
    matrix.multiply(u, product);
    lap(multiply_s);
  }
  std::printf("  body %.2f ms, pattern %.2f, stiffness %.2f, forces %.2f, product %.3f\n",
              1e3 * body_s, 1e3 * pattern_s, 1e3 * stiffness_s, 1e3 * forces_s, 1e3 * multiply_s);
}

}  // namespace

int main(int count, char** arguments) {
  int rounds = 5;
  double force = 0.1;
  Elasticity elasticity;
  elasticity.materials = {{1e4, 0.3, 1000}};
  elasticity.law = Law::kLinear;
  std::vector<int> sides;
  bool cholesky = false;
  for (int i = 1; i < count; ++i) {
    const std::string key = arguments[i];
    const char* value = i + 1 < count ? arguments[i + 1] : "";
    if (key == "--rounds") {
      rounds = std::atoi(value), ++i;
    }
    if (key == "--law") {
      for (const Law law : {Law::kLinear, Law::kCorotational, Law::kNeoHookean}) {
        elasticity.law = name_of(law) == value ? law : elasticity.law;
      }
      ++i;
    }
    if (key == "--poisson") {
      elasticity.materials[0].poisson = std::atof(value), ++i;
    }
    if (key == "--force") {
      force = std::atof(value), ++i;
    }
    if (key == "--tetrahedra") {
      elasticity.volume = VolumeForm::kTetrahedra;
    }
    if (key == "--cholesky") {
      cholesky = true;
    }
    if (key == "--sides") {
      while (i + 1 < count && arguments[i + 1][0] != '-') {
        sides.push_back(std::atoi(arguments[++i]));
      }
    }
  }
  if (sides.empty()) {
    sides = {16, 32};
  }
  for (const int side : sides) {
    const TetMesh mesh = haptrial::test::solid_block({side, side, side}, 0.1 / side);
    const LoadCase load = push(mesh, force);
    std::printf("%zu tetrahedra, %zu vertices, %s, nu %g\n", mesh.tetrahedra.size(),
                mesh.vertices.size(), std::string(name_of(elasticity.law)).c_str(),
                elasticity.materials[0].poisson);
    time_assembly(rounds, mesh, elasticity);
    for (const LinearSolver solver : {LinearSolver::kConjugateGradients, LinearSolver::kCholesky}) {
      if (solver == LinearSolver::kCholesky && !cholesky) {
        continue;
      }
      const Run run = best_of(rounds, mesh, elasticity, load, solver);
      double most = 0;
      for (const auto& u : run.result.displacement) {
        most = std::max(most, u.norm());
      }
      std::printf(
          "  %s: %.1f ms, %d load steps, %d Newton, %d iterations, residual %.1e, moved "
          "%.9g mm\n",
          solver == LinearSolver::kCholesky ? "CHOLMOD" : "gradients", 1e3 * run.seconds,
          run.result.load_steps, run.result.newton_steps, run.result.linear_iterations,
          run.result.residual, 1e3 * most);
    }
  }
}
