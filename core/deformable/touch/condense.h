#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

/// The stiffness of some vertices of a body when all others follow as they must (the Schur
/// complement): halves of the body are condensed to where they meet, these to where they meet
/// others, and so on (nested dissection).
/// After: A. George, Nested dissection of a regular finite element mesh, 1973.
/// @param stiffness  of all vertices  @param at  where they are [m]
/// @param held  by vertex: rows and columns left out
/// @param kept  vertices that are not held
/// @returns its lower half (3 kept x 3 kept) [N/m]
Eigen::MatrixXd condensed(const BlockMatrix& stiffness, std::span<const Eigen::Vector3d> at,
                          std::span<const std::uint8_t> held, std::span<const std::int32_t> kept);

/// Response of the outermost vertices, and of those below that keep them apart from the rest of the
/// body, to unit forces on the outermost [m/N].
struct SurfaceInverse {
  Eigen::MatrixXf outer;  // (3 outer x 3 outer)
  Eigen::MatrixXf below;  // (3 below x 3 outer)
};
/// @param outer, below  vertices that are not held; no block couples an outer vertex with others
SurfaceInverse surface_inverse(const BlockMatrix& stiffness, std::span<const Eigen::Vector3d> at,
                               std::span<const std::uint8_t> held,
                               std::span<const std::int32_t> outer,
                               std::span<const std::int32_t> below);

}  // namespace haptrial::deformable
