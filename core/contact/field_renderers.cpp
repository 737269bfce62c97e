#include "core/contact/field_renderers.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/geometry/mesh/mesh_size.h"

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

void DepthRenderer::start(const Vector3d& tool) noexcept {
  spring_.start();
  operations_ = {};
  contact_ = {};
  if (tool.allFinite()) {
    contact_.proxy = tool;
  }
}

/// A contact along one normal, or none.
const Contact& DepthRenderer::tick(const Vector3d& tool, double period) noexcept {
  if (!tool.allFinite()) {
    contact_.force.setZero();
    return contact_;
  }
  ++operations_.ticks;
  const SurfacePoint surface = below(tool, operations_);
  const double depth = std::max(-surface.distance, 0.0);
  const double force = spring_.force(depth, period);
  const bool touches = depth > 0.0;
  contact_.depth = depth;
  contact_.state = touches ? ContactState::kSlip : ContactState::kFree;
  contact_.normal = touches ? surface.normal : Vector3d(Vector3d::Zero());
  contact_.force = force * contact_.normal;
  contact_.proxy = tool + depth * contact_.normal;
  return contact_;
}

PenaltyRenderer::PenaltyRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                                 const RendererOptions& options)
    : DepthRenderer(options), distance_(mesh, surface) {}

SurfacePoint PenaltyRenderer::below(const Vector3d& tool, Operations& operations) noexcept {
  ++operations.nearest_searches;
  const SurfacePoint nearest = distance_(tool, hint_);
  hint_ = nearest.triangle;
  return nearest;
}

VoxelRenderer::VoxelRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                             const RendererOptions& options)
    : DepthRenderer(options),
      distance_(mesh, surface),
      grid_(mesh, options.resolution),
      nearest_(grid_.size()) {
  const Eigen::Array3i& n = grid_.count;
  parallel_for(static_cast<std::size_t>(n[2]), threads_or_all(0), [&](std::size_t z) {
    std::int32_t hint = -1;
    for (int y = 0; y < n[1]; ++y) {
      for (int x = 0; x < n[0]; ++x) {
        const Vector3d centre =
            grid_.origin + grid_.side * Vector3d(x + 0.5, y + 0.5, static_cast<double>(z) + 0.5);
        hint = surface.bvh().closest(centre, hint).triangle;
        nearest_[(z * n[1] + y) * n[0] + x] = hint;
      }
    }
  });
}

SurfacePoint VoxelRenderer::below(const Vector3d& tool, Operations& operations) noexcept {
  const Eigen::Array3d at = (tool - grid_.origin).array() / grid_.side;
  if (!(at >= 0.0).all() || !(at < grid_.count.cast<double>()).all()) {
    return {};
  }
  ++operations.cells;
  const Eigen::Array3i cell = at.cast<int>();
  const std::int32_t triangle =
      nearest_[(static_cast<std::size_t>(cell[2]) * grid_.count[1] + cell[1]) * grid_.count[0] +
               cell[0]];
  if (triangle < 0) {
    return {};
  }
  ++operations.triangles_tested;
  return distance_.of_plane(tool, triangle);
}

DistanceFieldRenderer::DistanceFieldRenderer(const geometry::Mesh& mesh,
                                             const ContactSurface& surface,
                                             const RendererOptions& options)
    : DepthRenderer(options), distance_(mesh, surface, options.resolution) {}

SurfacePoint DistanceFieldRenderer::below(const Vector3d& tool, Operations& operations) noexcept {
  operations.cells += distance_.holds(tool) ? 1 : 0;
  return distance_(tool);
}

}  // namespace haptrial::contact
