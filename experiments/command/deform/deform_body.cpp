#include "experiments/command/deform/deform_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text/nearest.h"
#include "experiments/command/deform/session_loads.h"
#include "experiments/control/interrupt.h"

namespace haptrial::experiments {

using deformable::SetupLoad;
using Eigen::Vector3d;

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

std::vector<NamedLoad> loads_of(const DeformBody& body, const std::vector<std::string>& names) {
  std::vector<std::string> allowed;
  for (const SetupLoad& load : body.setup.loads) {
    allowed.push_back(load.name);
  }
  for (const std::string& name : names) {
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
      throw InputError(not_allowed("the load", fmt::format("'{}'", name), allowed));
    }
  }
  if (allowed.empty()) {
    throw InputError(
        fmt::format("{}: there is no load; write [loads.NAME]", body.setup.file.string()));
  }
  std::vector<NamedLoad> loads;
  for (const SetupLoad& load : body.setup.loads) {
    if (!names.empty() && std::find(names.begin(), names.end(), load.name) == names.end()) {
      continue;
    }
    const deformable::LoadCase fixed = deformable::load_case_of(body.setup, load, body.mesh);
    if (load.session.empty()) {
      loads.push_back({load, fixed, false});
    } else {
      const auto touches = touches_of(body, load, fixed);
      loads.insert(loads.end(), touches.begin(), touches.end());
    }
  }
  for (const NamedLoad& load : loads) {
    deformable::check_load(body.mesh, load.load);
  }
  return loads;
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
  budget.check(fmt::format("statics of {} tetrahedra", tetrahedra),
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
