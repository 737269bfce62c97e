#include "core/geometry/mesh/triangle_distance.h"

#include "core/geometry/mesh/triangle_distance_lanes.h"

namespace haptrial::geometry {
namespace {

kernel::Lanes3<kernel::OneLane> lanes(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

ClosestPoint closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& corner0,
                                 const Eigen::Vector3d& corner1, const Eigen::Vector3d& corner2) {
  const auto nearest = kernel::nearest_on_triangle<kernel::OneLane>(lanes(point), lanes(corner0),
                                                                    lanes(corner1), lanes(corner2));
  return {nearest.distance_squared,
          {nearest.point.x, nearest.point.y, nearest.point.z},
          -1,
          static_cast<TrianglePart>(static_cast<int>(nearest.part))};
}

}  // namespace haptrial::geometry
