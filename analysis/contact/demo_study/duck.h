#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::evaluation {

/// A body that every ray from the origin leaves once: its radius by direction of unit length [m].
using RadialBody = std::function<double(const Eigen::Vector3d& direction)>;

/// A toy duck of our own making, 0.12 m long: an ellipsoid with a head, a beak and a tail that grow
/// out of it smoothly. y is up, x forwards.
/// @param direction  unit length
double duck_radius(const Eigen::Vector3d& direction);

/// The surface's normal: the gradient of |p| - r(p/|p|), by differences.
Eigen::Vector3d radial_normal(const RadialBody& body, const Eigen::Vector3d& direction);

/// A geodesic sphere drawn out to the body. @param frequency  20 frequency² triangles
geometry::Mesh radial_mesh(const RadialBody& body, int frequency);

struct ScanOptions {
  int frequency{84};    // 141,120 triangles
  double noise{0.001};  // of each point of the scan, along its ray [m]
  /// Passes of smoothing (each vertex the mean of itself and of its neighbours), in the place of
  /// the source's radial basis functions: they leave much less than the noise of single points.
  int smoothing{8};
  std::uint64_t seed{1};
};
/// A watertight mesh from noisy points.
geometry::Mesh scanned_mesh(const RadialBody& body, const ScanOptions& options = {});

/// The radius of a mesh around the origin, for meshes of it with fewer triangles.
/// @param mesh  must outlive the result, which throws std::invalid_argument where a ray hits
/// nothing
RadialBody radius_of(const geometry::Bvh& mesh);

}  // namespace haptrial::evaluation
