#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/mesh.h"

namespace haptrial::geometry {

/// What an open mesh lacks: with these triangles every edge is run along as often one way as the
/// other, whatever the mesh is like, so that the winding number of both together is a whole number
/// everywhere. Each loop of the boundary gets a fan of triangles around its own middle.
struct BoundaryCone {
  struct Fan {
    Eigen::Vector3d middle;  // [m]
    double radius;           // of a ball around the middle that holds the fan [m]
    double area;             // [m²]
  };
  Mesh mesh;
  std::vector<Fan> fans;
};
BoundaryCone boundary_cone(const Mesh& mesh);

/// How often the triangles wind around a point: the sum of the solid angles that they fill, over
/// 4π. Exact to rounding; all triangles are visited.
/// Source: van Oosterom and Strackee 1983.
double winding_sum(const Mesh& mesh, const Eigen::Vector3d& point);

}  // namespace haptrial::geometry
