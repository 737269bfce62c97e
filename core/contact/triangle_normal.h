#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// A unit normal of every triangle, on the side from which its corners run anticlockwise.
///
/// The corners of a triangle that is thinner than 2^-38 of `magnitude` do not tell its normal: they
/// are rounded to 2^-53 of it. Such a triangle takes the normal of the neighbour across its longest
/// edge, or, if all of those are as thin, any that is square to that edge. A triangle whose corners
/// coincide has the normal zero.
/// @param magnitude  the largest coordinate in size [m]
std::vector<Eigen::Vector3d> triangle_normals(const geometry::Mesh& mesh, double magnitude);

}  // namespace haptrial::contact
