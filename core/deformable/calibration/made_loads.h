#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/deformable/body/load_case.h"

namespace haptrial::deformable {

/// The displacement of the vertices under a load by the model that is trusted, taken as linear [m].
using Response = std::function<std::vector<Eigen::Vector3d>(const LoadCase&)>;

/// Makes loads where the body is least known: pushes along x, y and z on round patches that are
/// spread over the free surface. Each step takes the push whose response has the largest part
/// outside the span of the responses so far. The push is scaled so that the vertex that moves
/// farthest goes as far as under the given loads on average. The k-th made load is named "made k".
/// @param given  displacements under the loads that are there, each (vertices) [m]
/// @param holds  vertices that stay
/// @returns `count` loads, or fewer if the pushes run out
std::vector<LoadCase> made_loads(const geometry::TetMesh& body, const std::vector<Hold>& holds,
                                 std::span<const std::vector<Eigen::Vector3d>> given,
                                 std::size_t count, const Response& response);

/// Vertices that every load holds, each where it lies at rest.
std::vector<Hold> common_holds(std::span<const LoadCase> loads);

}  // namespace haptrial::deformable
