#include "experiments/command/deform/deform_body.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "experiments/control/signals.h"

namespace haptrial::experiments {

using Eigen::Vector3d;

void add_deform_input(CLI::App& sub, DeformInput& input, const char* what) {
  sub.add_option("BODY", input.file, what)->required();
  sub.add_option("--max-memory", input.max_memory,
                 "Limit of memory [GB]; a larger body is refused (default: the free memory)");
}

DeformBody load_deform_body(const DeformInput& input) {
  const MemoryBudget budget(input.max_memory);
  DeformBody body;
  body.setup = deformable::read_setup(input.file);
  body.mesh = deformable::body_of(
      body.setup, [&](const std::string& what, double bytes) { budget.check(what, bytes); });
  deformable::check_body(body.mesh, input.file);
  body.elasticity = deformable::elasticity_of(body.setup, body.mesh);
  return body;
}

deformable::SpringBody springs_of(const DeformBody& body,
                                  const deformable::UniformConstants& constants) {
  return deformable::spring_body(
      body.mesh, deformable::densities(body.elasticity, body.mesh.tetrahedra.size()), constants);
}

void check_memory_of(const DeformBody& body, double by_tetrahedron, const MemoryBudget& budget) {
  const std::size_t tetrahedra = body.mesh.tetrahedra.size();
  budget.check(fmt::format("what is computed on {} tetrahedra", tetrahedra),
               by_tetrahedron * static_cast<double>(tetrahedra));
}

deformable::StaticSolver static_solver(const DeformBody& body,
                                       const deformable::ElasticBody& elastic,
                                       const MemoryBudget& budget) {
  double poisson = -1.0;
  for (const deformable::Material& material : body.elasticity.materials) {
    poisson = std::max(poisson, material.poisson);
  }
  const std::size_t vertices = body.mesh.vertices.size();
  const std::size_t tetrahedra = body.mesh.tetrahedra.size();
  constexpr double kByState = 250.0;  // by tetrahedron: the body, and what is written of it [bytes]
  budget.check(fmt::format("statics of {} tetrahedra", tetrahedra),
               kByState * static_cast<double>(tetrahedra) +
                   deformable::static_memory(vertices, tetrahedra,
                                             deformable::faster_solver(vertices, poisson)));
  return deformable::StaticSolver(elastic, {.tolerance = body.setup.tolerance});
}

std::vector<Vector3d> moved_by(const geometry::TetMesh& mesh,
                               const std::vector<Vector3d>& displacement) {
  std::vector<Vector3d> moved(mesh.vertices.begin(), mesh.vertices.end());
  for (std::size_t v = 0; v < moved.size(); ++v) {
    moved[v] += displacement[v];
  }
  return moved;
}

void check_interrupt() {
  if (interrupted()) {
    throw geometry::Cancelled();
  }
}

double root_mean_square(const std::vector<Vector3d>& vectors) {
  double sum = 0.0;
  for (const Vector3d& v : vectors) {
    sum += v.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(vectors.size()));
}

}  // namespace haptrial::experiments
