#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/elements/elastic_body.h"

namespace haptrial::evaluation {

/// A body that gives way, what holds it, and what acts on it. Gripped vertices go with the tool,
/// which is not turned.
struct SoftBody {
  geometry::TetMesh mesh;
  deformable::Elasticity elasticity;
  std::vector<std::int32_t> fixed;             // vertices that stay
  std::vector<std::int32_t> gripped;           // vertices that the tool takes with it
  std::vector<deformable::NodalForce> forces;  // at a load of 1

  bool is_free() const { return fixed.empty() && gripped.empty(); }
};

/// Holds and forces with the tool moved from its first place [m] and a share of the forces.
deformable::LoadCase load_case_of(const SoftBody& body, const Eigen::Vector3d& tool, double load);

/// TetGen's .node and .ele with attributes: a vertex has its force (N) and a marker, 1 fixed and 2
/// gripped; a tetrahedron Young's modulus (Pa), Poisson's ratio and density (kg/m³).
std::string node_text(const SoftBody& body);
std::string element_text(const SoftBody& body);
/// @param node_file  NAME.node, with NAME.ele beside it
/// @throws InputError as deformable::read_tetgen(), for attributes that are missing or not allowed.
SoftBody read_soft_body(const std::filesystem::path& node_file);

}  // namespace haptrial::evaluation
