#include "core/bone/drill/burr_on_tick.h"

namespace haptrial::bone {
namespace {

using Eigen::Vector3d;

/// Whether a burr comes near a cube. The search goes from the nearest surface point of a solid to
/// the nearest point of a cube and back, until they meet or come no nearer to each other: both are
/// convex.
bool meets(const BurrOnTick& burr, const Vector3d& low, const Vector3d& high,
           double close) noexcept {
  constexpr int kSteps = 100;
  Vector3d p = burr.centre.cwiseMax(low).cwiseMin(high);
  for (int step = 0; step < kSteps; ++step) {
    const Vector3d from = p - burr.centre;
    const double along = burr.axis.dot(from);
    const Vector3d lateral = from - along * burr.axis;
    const double across = lateral.norm();
    const BurrShape::Nearest near = burr.shape->nearest({across, 0.0, along});
    if (near.distance <= close) {
      return true;
    }
    const Vector3d outwards =
        near.normal.z() * burr.axis +
        (across > 0.0 ? Vector3d(near.normal.x() / across * lateral) : Vector3d(Vector3d::Zero()));
    const Vector3d next = (p - near.distance * outwards).cwiseMax(low).cwiseMin(high);
    if ((next - p).norm() < 0.01 * close) {
      return false;
    }
    p = next;
  }
  return false;
}

}  // namespace

bool BurrOnTick::touches(const geometry::VoxelGrid& grid, const Voxel& voxel) const noexcept {
  if (!(radius > 0.0)) {
    return false;
  }
  const Vector3d middle = grid.centre(voxel.x(), voxel.y(), voxel.z());
  const Eigen::Array3d beyond =
      ((centre - middle).array().abs() - 0.5 * grid.spacing).max(0.0);  // the cube, per axis
  const double farthest = reach();
  if (!(beyond.matrix().squaredNorm() <= farthest * farthest)) {
    return false;
  }
  const Vector3d half = Vector3d::Constant(0.5 * grid.spacing);
  return shape == nullptr || meets(*this, middle - half, middle + half, 1e-3 * grid.spacing);
}

BurrOnTick in_frame(const Eigen::Isometry3d& X, const BurrOnTick& burr) noexcept {
  BurrOnTick moved = burr;
  moved.centre = X * burr.centre;
  moved.axis = X.linear() * burr.axis;
  return moved;
}

}  // namespace haptrial::bone
