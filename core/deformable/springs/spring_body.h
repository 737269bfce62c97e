#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/deformable/body/mesh_parts.h"
#include "core/deformable/springs/spring_energies.h"
#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// The constants of a material that is the same everywhere.
struct UniformConstants {
  double length{};  // of every edge, >= 0 [J]
  double area{};    // of every face, >= 0 [J]
  double volume{};  // of every tetrahedron, >= 0 [J]

  bool operator==(const UniformConstants&) const = default;
};

/// The constants k of each spring (spring_energies.h), all >= 0.
struct SpringConstants {
  std::vector<double> length;  // (edges) [J]
  std::vector<double> area;    // (faces) [J]
  std::vector<double> volume;  // (tetrahedra) [J]
};

/// Masses that springs of length, area and volume hold together. Made by spring_body().
/// Source: Morris 2006, §5.4.1.
struct SpringBody {
  std::vector<Eigen::Vector3d> rest;              // (vertices) [m]
  std::vector<geometry::Tetrahedron> tetrahedra;  // each of positive volume at rest
  MeshParts parts;
  std::vector<double> lengths;  // (edges) at rest [m]
  std::vector<double> areas;    // (faces) at rest [m²]
  std::vector<double> volumes;  // (tetrahedra) at rest [m³]
  std::vector<double> masses;   // (vertices), a quarter of each tetrahedron's to its corners [kg]
  SpringConstants constants;
};

/// @param name  of the body, as a message calls it
/// @param density  > 0 [kg/m³]
/// @throws InputError naming the body: what check_body() refuses, a density or a constant that is
/// not allowed.
SpringBody spring_body(const geometry::TetMesh& mesh, double density,
                       const UniformConstants& constants, const std::string& name = "body");
/// @param densities  of each tetrahedron: a body of several materials [kg/m³]
SpringBody spring_body(const geometry::TetMesh& mesh, std::span<const double> densities,
                       const UniformConstants& constants, const std::string& name = "body");

/// The same constants for every edge, face and tetrahedron of the body.
SpringConstants spread(const SpringBody& body, const UniformConstants& constants);

/// @throws InputError for a list of another length than the body's, or a constant below 0 or not
/// finite.
void check_constants(const SpringBody& body, const SpringConstants& constants);

/// The energy of all springs [J] with vertices at `positions` [m].
double spring_energy(const SpringBody& body, std::span<const Eigen::Vector3d> positions);

/// The force on every vertex [N], spring after spring: what the fast kernel is held against.
std::vector<Eigen::Vector3d> spring_forces(const SpringBody& body,
                                           std::span<const Eigen::Vector3d> positions,
                                           ForceForm form = ForceForm::kExact);

/// How many tetrahedra have a volume that is not above 0.
std::size_t inverted_tetrahedra(const SpringBody& body, std::span<const Eigen::Vector3d> positions);

/// The points of an edge, face or tetrahedron.
template <std::size_t n>
std::array<Eigen::Vector3d, n> points_of(std::span<const Eigen::Vector3d> positions,
                                         const std::array<std::int32_t, n>& vertices) {
  std::array<Eigen::Vector3d, n> points;
  for (std::size_t i = 0; i < n; ++i) {
    points[i] = positions[static_cast<std::size_t>(vertices[i])];
  }
  return points;
}

}  // namespace haptrial::deformable
