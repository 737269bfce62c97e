#include "core/geometry/files/cut_face.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/mesh/predicates.h"

namespace haptrial::geometry::reading {
namespace {

double area_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d ac = c - a;
  return 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
}

}  // namespace

void FaceCutter::project(const std::vector<Eigen::Vector3d>& vertices,
                         std::span<const std::int32_t> corners) {
  const Eigen::Vector3d& first = vertices[static_cast<std::size_t>(corners[0])];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d covered = Eigen::Vector3d::Zero();
  double largest = 0.0;
  double extent = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& here = vertices[static_cast<std::size_t>(corners[i])];
    const Eigen::Vector3d& there =
        vertices[static_cast<std::size_t>(corners[(i + 1) % corners.size()])];
    const Eigen::Vector3d twice = (here - first).cross(there - first);
    normal += twice;
    covered += twice.cwiseAbs();
    largest = std::max(largest, here.cwiseAbs().maxCoeff());
    extent = std::max(extent, (here - first).cwiseAbs().maxCoeff());
  }
  // Far from the origin a millionth of the coordinates may be as large as the face itself.
  constexpr double kMost = 1e-3;  // of the face's extent
  most_rounding_ = 1e-6 * largest * extent;
  rounding_ = std::min(most_rounding_, kMost * extent * extent);
  int axis = 0;
  if (normal.cwiseAbs().maxCoeff(&axis) <= rounding_) {
    covered.maxCoeff(&axis);  // the loops of a face that crosses itself may cancel
  }
  const bool turned = normal[axis] < 0.0;
  const int x = (axis + (turned ? 2 : 1)) % 3;
  const int y = (axis + (turned ? 1 : 2)) % 3;
  points_.clear();
  for (const std::int32_t corner : corners) {
    const Eigen::Vector3d& point = vertices[static_cast<std::size_t>(corner)];
    points_.emplace_back(point[x], point[y]);
  }
}

bool FaceCutter::fan_fits(double rounding) const {
  double folded = 0.0;
  double angle = 0.0;
  for (std::size_t i = 2; i < points_.size(); ++i) {
    const double area = area_of(points_[0], points_[i - 1], points_[i]);
    folded -= std::min(area, 0.0);
    angle += std::atan2(2.0 * area, (points_[i - 1] - points_[0]).dot(points_[i] - points_[0]));
  }
  return folded <= rounding && angle <= 2.0 * std::numbers::pi + 1e-6;
}

bool FaceCutter::is_ear(std::size_t corner) const {
  const Eigen::Vector2d& a = points_[previous_[corner]];
  const Eigen::Vector2d& b = points_[corner];
  const Eigen::Vector2d& c = points_[next_[corner]];
  if (side_of_line(a, b, c) <= 0) {
    return false;
  }
  const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c);
  const Eigen::Vector2d high = a.cwiseMax(b).cwiseMax(c);
  for (std::size_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
    const Eigen::Vector2d& p = points_[i];
    const bool near = (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
    // A face with a hole passes twice through the ends of the edge that leads to the hole.
    if (near && p != a && p != b && p != c && side_of_line(a, b, p) >= 0 &&
        side_of_line(b, c, p) >= 0 && side_of_line(c, a, p) >= 0) {
      return false;
    }
  }
  return true;
}

bool FaceCutter::clip_ears(std::span<const std::int32_t> corners, std::span<Triangle> triangles) {
  const std::size_t count = corners.size();
  next_.resize(count);
  previous_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    next_[i] = (i + 1) % count;
    previous_[i] = (i + count - 1) % count;
  }
  std::size_t corner = 0;
  std::size_t refused = 0;  // corners in a row that are no ears
  std::size_t found = 0;
  for (std::size_t left = count; left > 3;) {
    if (!is_ear(corner)) {
      if (++refused > left) {
        return false;
      }
      corner = next_[corner];
      continue;
    }
    triangles[found++] = {corners[previous_[corner]], corners[corner], corners[next_[corner]]};
    next_[previous_[corner]] = next_[corner];
    previous_[next_[corner]] = previous_[corner];
    corner = previous_[corner];
    refused = 0;
    --left;
  }
  triangles[found] = {corners[previous_[corner]], corners[corner], corners[next_[corner]]};
  return area_of(points_[previous_[corner]], points_[corner], points_[next_[corner]]) >= -rounding_;
}

const char* FaceCutter::cut(const std::vector<Eigen::Vector3d>& vertices,
                            std::span<const std::int32_t> corners, std::span<Triangle> triangles) {
  project(vertices, corners);
  const bool fan = fan_fits(rounding_);
  const bool too_many = corners.size() > kMostConcaveCorners;
  if (!fan && !too_many && clip_ears(corners, triangles)) {
    return "";
  }
  if (!fan && !fan_fits(most_rounding_)) {
    return too_many ? "has a concave corner; allowed with more than 10,000 corners: convex faces"
                    : "crosses itself; allowed: faces whose edges do not cross";
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles[i - 2] = {corners[0], corners[i - 1], corners[i]};
  }
  return "";
}

}  // namespace haptrial::geometry::reading
