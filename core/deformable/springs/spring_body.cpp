#include "core/deformable/springs/spring_body.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"
#include "core/deformable/body/load_case.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::span<const Vector3d>;

void measure_rest(SpringBody& body) {
  for (const Edge& edge : body.parts.edges) {
    const Points2 p = points_of(body.rest, edge);
    body.lengths.push_back((p[1] - p[0]).norm());
  }
  for (const Face& face : body.parts.faces) {
    body.areas.push_back(area_of(points_of(body.rest, face)));
  }
  for (const geometry::Tetrahedron& t : body.tetrahedra) {
    body.volumes.push_back(volume_of(points_of(body.rest, t)));
  }
}

void lump_masses(SpringBody& body, std::span<const double> densities) {
  body.masses.assign(body.rest.size(), 0.0);
  for (std::size_t i = 0; i < body.tetrahedra.size(); ++i) {
    for (const std::int32_t vertex : body.tetrahedra[i]) {
      body.masses[static_cast<std::size_t>(vertex)] += 0.25 * densities[i] * body.volumes[i];
    }
  }
}

void check_list(const std::vector<double>& list, std::size_t count, const char* what) {
  if (list.size() != count) {
    throw InputError(
        fmt::format("springs: {} constants of {} are given for {}", list.size(), what, count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isfinite(list[i]) && list[i] >= 0) {
      continue;
    }
    throw InputError(
        fmt::format("springs: constant {} of {} is {} J; at least 0 is allowed", i, what, list[i]));
  }
}

template <std::size_t n>
void add_forces(const std::array<std::int32_t, n>& vertices, const std::array<Vector3d, n>& forces,
                std::vector<Vector3d>& sums) {
  for (std::size_t i = 0; i < n; ++i) {
    sums[static_cast<std::size_t>(vertices[i])] += forces[i];
  }
}

}  // namespace

SpringBody spring_body(const geometry::TetMesh& mesh, double density,
                       const UniformConstants& constants, const std::string& name) {
  return spring_body(mesh, std::vector<double>(mesh.tetrahedra.size(), density), constants, name);
}

SpringBody spring_body(const geometry::TetMesh& mesh, std::span<const double> densities,
                       const UniformConstants& constants, const std::string& name) {
  check_body(mesh, name);
  if (densities.size() != mesh.tetrahedra.size()) {
    throw InputError(fmt::format("{}: {} densities are given for {} tetrahedra", name,
                                 densities.size(), mesh.tetrahedra.size()));
  }
  for (const double density : densities) {
    if (!std::isfinite(density) || density <= 0) {
      throw InputError(
          fmt::format("{}: the density is {} kg/m³; above 0 is allowed", name, density));
    }
  }
  SpringBody body;
  body.rest.assign(mesh.vertices.begin(), mesh.vertices.end());
  body.tetrahedra.assign(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
  body.parts = mesh_parts(body.tetrahedra);
  measure_rest(body);
  lump_masses(body, densities);
  body.constants = spread(body, constants);
  check_constants(body, body.constants);
  return body;
}

SpringConstants spread(const SpringBody& body, const UniformConstants& constants) {
  return {std::vector<double>(body.parts.edges.size(), constants.length),
          std::vector<double>(body.parts.faces.size(), constants.area),
          std::vector<double>(body.tetrahedra.size(), constants.volume)};
}

void check_constants(const SpringBody& body, const SpringConstants& constants) {
  check_list(constants.length, body.parts.edges.size(), "edges");
  check_list(constants.area, body.parts.faces.size(), "faces");
  check_list(constants.volume, body.tetrahedra.size(), "tetrahedra");
}

double spring_energy(const SpringBody& body, Positions positions) {
  double energy = 0;
  for (std::size_t i = 0; i < body.lengths.size(); ++i) {
    energy += length_energy({body.constants.length[i], body.lengths[i]},
                            points_of(positions, body.parts.edges[i]));
  }
  for (std::size_t i = 0; i < body.areas.size(); ++i) {
    energy += area_energy({body.constants.area[i], body.areas[i]},
                          points_of(positions, body.parts.faces[i]));
  }
  for (std::size_t i = 0; i < body.volumes.size(); ++i) {
    energy += volume_energy({body.constants.volume[i], body.volumes[i]},
                            points_of(positions, body.tetrahedra[i]));
  }
  return energy;
}

std::vector<Vector3d> spring_forces(const SpringBody& body, Positions positions, ForceForm form) {
  std::vector<Vector3d> sums(body.rest.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < body.lengths.size(); ++i) {
    const Edge& edge = body.parts.edges[i];
    const Spring spring{body.constants.length[i], body.lengths[i]};
    add_forces(edge, length_forces(spring, points_of(positions, edge)), sums);
  }
  for (std::size_t i = 0; i < body.areas.size(); ++i) {
    const Face& face = body.parts.faces[i];
    const Spring spring{body.constants.area[i], body.areas[i]};
    add_forces(face, area_forces(spring, points_of(positions, face), form), sums);
  }
  for (std::size_t i = 0; i < body.volumes.size(); ++i) {
    const geometry::Tetrahedron& t = body.tetrahedra[i];
    const Spring spring{body.constants.volume[i], body.volumes[i]};
    add_forces(t, volume_forces(spring, points_of(positions, t), form), sums);
  }
  return sums;
}

std::size_t inverted_tetrahedra(const SpringBody& body, Positions positions) {
  std::size_t count = 0;
  for (const geometry::Tetrahedron& t : body.tetrahedra) {
    if (!(volume_of(points_of(positions, t)) > 0)) {
      ++count;  // also where it is not a number
    }
  }
  return count;
}

}  // namespace haptrial::deformable
