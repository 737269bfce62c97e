#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "core/geometry/mesh/mesh.h"
#include "protocols/psychophysics/objects/trial_object.h"

namespace haptrial::protocols {

using Outline = std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>;  // lines in W [m]

/// Lines of an object that is seen along a direction: the sides of triangles where the surface
/// turns away from the eye, and its creases.
/// @param along  of the view in W, away from the eye, of length 1
Outline outline_of(const geometry::Mesh& mesh, const SeenObject& seen,
                   const Eigen::Vector3d& along);

}  // namespace haptrial::protocols
