#include "core/contact/rigid_tool.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptrial::contact {

using Eigen::Vector3d;

namespace {

constexpr double kReach = 1e-3;  // a tool that touches goes less far in a tick [m]

/// Whether two faces meet in a groove: each lies before the other, not behind it as at a ridge.
bool is_groove(const SurfacePoint& a, const SurfacePoint& b) noexcept {
  const Vector3d way = b.point - a.point;
  return a.normal.dot(way) >= 0.0 && b.normal.dot(way) <= 0.0;
}

}  // namespace

std::vector<Vector3d> points_on(const geometry::Mesh& mesh, double spacing) {
  std::vector<Vector3d> points;
  for (const geometry::Triangle& triangle : mesh.triangles) {
    const std::array<Vector3d, 3> corner{mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                                         mesh.vertices[triangle[2]]};
    const double longest = std::max({(corner[1] - corner[0]).norm(), (corner[2] - corner[1]).norm(),
                                     (corner[0] - corner[2]).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) {
        const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
        points.emplace_back((1.0 - u - v) * corner[0] + u * corner[1] + v * corner[2]);
      }
    }
  }
  // Points of shared edges differ by rounding alone.
  const double grain = 1e-6 * spacing;
  const auto key = [&](const Vector3d& p) {
    const Eigen::Array3d on_grid = (p.array() / grain).round();
    return std::array{on_grid[0], on_grid[1], on_grid[2]};
  };
  std::ranges::sort(points, {}, key);
  const auto repeated = std::ranges::unique(points, {}, key);
  points.erase(repeated.begin(), repeated.end());
  return points;
}

RigidTool::RigidTool(const std::vector<Vector3d>& points, const Coupling& coupling)
    : tool_(coupling) {
  points_.reserve(points.size());
  for (const Vector3d& point : points) {
    points_.push_back({point, Vector3d::Zero(), -1.0, -1});
  }
  near_.reserve(2 * points.size());
}

void RigidTool::begin(const Eigen::Isometry3d& hand) noexcept {
  tool_.begin(hand);
  near_.clear();
  for (Point& point : points_) {
    point.distance = -1.0;
    point.near = -1;
    point.last = point.other = {};
  }
}

void RigidTool::remember(Point& point, const SurfacePoint& surface) const noexcept {
  constexpr double kSameSide = 0.999;  // cosine of normals
  if (surface.normal.dot(point.last.normal) < kSameSide) {
    point.other = point.last;
  }
  point.last = surface;
  const bool holds = (point.asked - point.other.point).squaredNorm() < 4.0 * kReach * kReach &&
                     is_groove(surface, point.other);
  if (!holds) {
    point.other.normal.setZero();
  }
}

void RigidTool::find_near(const BodyDistance& body) noexcept {
  near_.clear();
  for (Point& point : points_) {
    const Vector3d lever = tool_.pose().linear() * point.at_T;
    const Vector3d at = tool_.pose().translation() + lever;
    const double spare = point.distance - kReach;  // that it could go without coming near
    if (spare > 0.0 && (at - point.asked).squaredNorm() < spare * spare) {
      continue;
    }
    const SurfacePoint surface = body(at, point.near);
    point.asked = at;
    point.distance = surface.distance;
    point.near = surface.triangle;
    if (surface.distance >= kReach) {
      point.last = point.other = {};
      continue;
    }
    near_.push_back({lever, surface.normal, -surface.distance});
    remember(point, surface);
    if (!point.other.normal.isZero(0.0)) {
      near_.push_back({lever, point.other.normal, point.other.normal.dot(point.other.point - at)});
    }
  }
}

CoupledTool::Felt RigidTool::tick(const BodyDistance& body, const Eigen::Isometry3d& hand,
                                  double dt) noexcept {
  if (!hand.matrix().allFinite()) {
    return {};
  }
  find_near(body);
  return tool_.follow(hand, near_, dt);
}

}  // namespace haptrial::contact
