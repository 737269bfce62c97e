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

namespace {

/// A contact along one normal, or none.
void press(const Vector3d& tool, double distance, const Vector3d& normal, double period,
           NormalSpring& spring, Contact& contact) {
  const double depth = std::max(-distance, 0.0);
  const double force = spring.force(depth, period);
  const bool touches = depth > 0.0;
  contact.depth = depth;
  contact.state = touches ? ContactState::kSlip : ContactState::kFree;
  contact.normal = touches ? normal : Vector3d(Vector3d::Zero());
  contact.force = force * contact.normal;
  contact.proxy = tool + depth * contact.normal;
}

void begin(const Vector3d& tool, NormalSpring& spring, Contact& contact, Operations& operations) {
  spring.start();
  operations = {};
  contact = {};
  if (tool.allFinite()) {
    contact.proxy = tool;
  }
}

bool refused(const Vector3d& tool, Contact& contact) {
  if (!tool.allFinite()) {
    contact.force.setZero();
    return true;
  }
  return false;
}

}  // namespace

PenaltyRenderer::PenaltyRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                                 const RendererOptions& options)
    : distance_(mesh, surface), spring_(options) {}

void PenaltyRenderer::start(const Vector3d& tool) noexcept {
  begin(tool, spring_, contact_, operations_);
}

const Contact& PenaltyRenderer::tick(const Vector3d& tool, double period) noexcept {
  if (refused(tool, contact_)) {
    return contact_;
  }
  ++operations_.ticks;
  ++operations_.nearest_searches;
  const SurfacePoint nearest = distance_(tool, hint_);
  hint_ = nearest.triangle;
  press(tool, nearest.distance, nearest.normal, period, spring_, contact_);
  return contact_;
}

VoxelRenderer::VoxelRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                             const RendererOptions& options)
    : distance_(mesh, surface),
      grid_(mesh, options.resolution),
      nearest_(grid_.size()),
      spring_(options) {
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

void VoxelRenderer::start(const Vector3d& tool) noexcept {
  begin(tool, spring_, contact_, operations_);
}

const Contact& VoxelRenderer::tick(const Vector3d& tool, double period) noexcept {
  if (refused(tool, contact_)) {
    return contact_;
  }
  ++operations_.ticks;
  const Eigen::Array3d at = (tool - grid_.origin).array() / grid_.side;
  SurfacePoint below;
  if ((at >= 0.0).all() && (at < grid_.count.cast<double>()).all()) {
    ++operations_.cells;
    const Eigen::Array3i cell = at.cast<int>();
    const std::int32_t triangle =
        nearest_[(static_cast<std::size_t>(cell[2]) * grid_.count[1] + cell[1]) * grid_.count[0] +
                 cell[0]];
    if (triangle >= 0) {
      ++operations_.triangles_tested;
      below = distance_.of_plane(tool, triangle);
    }
  }
  press(tool, below.distance, below.normal, period, spring_, contact_);
  return contact_;
}

DistanceFieldRenderer::DistanceFieldRenderer(const geometry::Mesh& mesh,
                                             const ContactSurface& surface,
                                             const RendererOptions& options)
    : distance_(mesh, surface, options.resolution), spring_(options) {}

void DistanceFieldRenderer::start(const Vector3d& tool) noexcept {
  begin(tool, spring_, contact_, operations_);
}

const Contact& DistanceFieldRenderer::tick(const Vector3d& tool, double period) noexcept {
  if (refused(tool, contact_)) {
    return contact_;
  }
  ++operations_.ticks;
  operations_.cells += distance_.holds(tool) ? 1 : 0;
  const SurfacePoint below = distance_(tool);
  press(tool, below.distance, below.normal, period, spring_, contact_);
  return contact_;
}

}  // namespace haptrial::contact
