#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/body/mesh_parts.h"

namespace haptrial::deformable {

/// Points on the faces of a body that stay where they are in the material: corners, and points
/// between them in equal steps. Those on an edge or corner are there once.
struct SurfaceSamples {
  struct Sample {
    std::array<std::int32_t, 3> corners{};  // into `rest`; all of them on each of its faces
    Eigen::Vector3d weight{Eigen::Vector3d::Zero()};
    Eigen::Vector3d outward{Eigen::Vector3d::Zero()};  // at rest: the mean over its faces
    Eigen::Vector3d rest{Eigen::Vector3d::Zero()};     // where it is then [m]
  };

  /// @param faces  of corners into `rest` [m], outward  @param steps  along an edge, at least 1
  SurfaceSamples(std::span<const Face> faces, std::span<const Eigen::Vector3d> rest, int steps);

  std::span<const std::int32_t> on(std::int32_t face) const noexcept {
    return std::span(of_face).subspan(static_cast<std::size_t>(face) * per_face, per_face);
  }

  std::vector<Sample> samples;
  std::vector<std::int32_t> of_face;  // (faces x per_face)
  std::size_t per_face{0};
};

}  // namespace haptrial::deformable
