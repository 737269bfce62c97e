#include "core/contact/sampled_distance.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/geometry/mesh/mesh_bounds.h"

namespace haptrial::contact {

using Eigen::Vector3d;

CellGrid::CellGrid(const geometry::Mesh& mesh, int resolution) {
  const Eigen::AlignedBox3d box = geometry::bounds(mesh);
  side = std::max(box.sizes().maxCoeff(), 1e-300) / resolution;
  origin = box.min() - Vector3d::Constant(2.0 * side);
  count = ((box.sizes() / side).array().ceil().cast<int>() + 4).max(5);
}

SampledDistance::SampledDistance(const geometry::Mesh& mesh, const ContactSurface& surface,
                                 int resolution)
    : grid_(mesh, resolution) {
  const SignedDistance distance(mesh, surface);
  const Eigen::Array3i n = grid_.count + 1;
  distance_.resize(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
  parallel_for(static_cast<std::size_t>(n[2]), threads_or_all(0), [&](std::size_t z) {
    std::int32_t hint = -1;
    for (int y = 0; y < n[1]; ++y) {
      for (int x = 0; x < n[0]; ++x) {
        const Vector3d corner = grid_.origin + grid_.side * Vector3d(x, y, static_cast<double>(z));
        const SurfacePoint nearest = distance(corner, hint);
        hint = nearest.triangle;
        distance_[(z * n[1] + y) * n[0] + x] = nearest.distance;
      }
    }
  });
}

bool SampledDistance::holds(const Vector3d& point) const noexcept {
  const Eigen::Array3d at = (point - grid_.origin).array() / grid_.side;
  return (at >= 0.0).all() && (at < grid_.count.cast<double>()).all();
}

SurfacePoint SampledDistance::operator()(const Vector3d& point, std::int32_t) const noexcept {
  SurfacePoint answer;
  const Eigen::Array3d at = (point - grid_.origin).array() / grid_.side;
  if (!holds(point)) {
    const Eigen::Array3d inside = at.max(0.0).min(grid_.count.cast<double>());
    answer.distance = grid_.side * (at - inside).matrix().norm();
    return answer;
  }
  const Eigen::Array3i cell = at.cast<int>(), n = grid_.count + 1;
  const Eigen::Array3d u = at - cell.cast<double>();
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double d = distance_[(static_cast<std::size_t>(cell[2] + k) * n[1] + cell[1] + j) * n[0] +
                               cell[0] + i];
    const double wx = i ? u[0] : 1.0 - u[0], wy = j ? u[1] : 1.0 - u[1];
    const double wz = k ? u[2] : 1.0 - u[2];
    answer.distance += wx * wy * wz * d;
    answer.normal +=
        d / grid_.side *
        Vector3d((i ? 1 : -1) * wy * wz, (j ? 1 : -1) * wx * wz, (k ? 1 : -1) * wx * wy);
  }
  answer.point = point - answer.distance * answer.normal;
  return answer;
}

}  // namespace haptrial::contact
