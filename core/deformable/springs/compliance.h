#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// How far small forces move the vertices of a body that rests at `positions`: K^-1 f with the
/// exact Hessian K there; 0 for held vertices. One factorization.
/// @param forces  (vertices) [N]; those on held vertices do nothing
/// @returns displacements (vertices) [m]; nothing where K is not positive definite
std::optional<std::vector<Eigen::Vector3d>> small_displacements(
    const SpringBody& body, std::span<const Hold> holds, std::span<const Eigen::Vector3d> positions,
    std::span<const Eigen::Vector3d> forces);

}  // namespace haptrial::deformable
