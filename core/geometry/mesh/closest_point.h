#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>

namespace haptrial::geometry {

using Corners = std::array<Eigen::Vector3d, 3>;  // of a triangle [m]

/// Which part of a triangle a point lies on: its face, or an edge or corner of it. Edge i runs from
/// corner i to corner i + 1.
enum class TrianglePart : std::uint8_t {
  kFace,
  kEdge0,
  kEdge1,
  kEdge2,
  kCorner0,
  kCorner1,
  kCorner2
};

/// The nearest point of a mesh.
struct ClosestPoint {
  double distance_squared{std::numeric_limits<double>::infinity()};  // [m²]
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};                    // on the surface [m]
  std::int32_t triangle{-1};  // the lowest of those equally near; -1: the mesh has none
  TrianglePart part{TrianglePart::kFace};
};

}  // namespace haptrial::geometry
