#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// A vertex that is held where it lies, or moved by a known way.
struct Hold {
  std::int32_t vertex{};
  Eigen::Vector3d displacement{Eigen::Vector3d::Zero()};  // from the rest place [m]
};

/// A constant force on one vertex.
struct NodalForce {
  std::int32_t vertex{};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // [N]
};

/// Held vertices of a body and the loads on it, all at once. Source: Morris 2006, §5.3.2 ("a known
/// set of loads").
struct LoadCase {
  std::string name;
  std::vector<Hold> holds;         // each vertex at most once
  std::vector<NodalForce> forces;  // several on one vertex are summed
};

/// 1 for each vertex that a load holds.
std::vector<std::uint8_t> held_flags(std::size_t vertices, std::span<const Hold> holds);

/// @param name  of the body, as a message calls it
/// @throws InputError for a vertex that is not finite or that no tetrahedron has, a corner without
/// a vertex, and an inverted or flat tetrahedron (its six-fold volume below 1e-6 of its longest
/// edge's cube).
void check_body(const geometry::TetMesh& body, const std::string& name);

/// @throws InputError naming the load: a vertex that the body has not, or that is held twice; a
/// displacement or force that is not finite; neither force nor displacement; or a part of the body
/// that can move freely, with less than three held vertices or all of them on one line.
void check_load(const geometry::TetMesh& body, const LoadCase& load);

}  // namespace haptrial::deformable
