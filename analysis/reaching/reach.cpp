#include "analysis/reaching/reach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::analysis {

WayFrame::WayFrame(const Eigen::Vector3d& start, const Eigen::Vector3d& target,
                   const Eigen::Vector3d& normal) {
  if (!(normal.norm() > 0.0) || !normal.allFinite()) {
    throw std::invalid_argument("normal must not be 0");
  }
  const Eigen::Vector3d up = normal.normalized();
  const Eigen::Vector3d way = target - start;
  const Eigen::Vector3d flat = way - up * up.dot(way);
  distance_ = flat.norm();
  if (!(distance_ > 1e-9 * way.norm()) || !std::isfinite(distance_)) {
    throw std::invalid_argument("start and target must differ within the plane of the movement");
  }
  along_ = flat / distance_;
  left_ = up.cross(along_);
}

double WayFrame::lateral(const Eigen::Vector3d& vector) const {
  constexpr double kRounding = 1e-14;  // of positions that were filtered and rotated
  const double part = left_.dot(vector);
  return std::abs(part) <= kRounding * vector.norm() ? 0.0 : part;
}

double WayFrame::angle(const Eigen::Vector3d& vector) const {
  return std::atan2(lateral(vector), along(vector));
}

void check_reach(const Reach& reach) {
  if (reach.time.size() < 2 || std::ranges::adjacent_find(reach.time, [](double a, double b) {
                                 return !(b > a);
                               }) != reach.time.end()) {
    throw std::invalid_argument("time must have two samples or more and rise");
  }
  if (reach.position.size() != reach.time.size()) {
    throw std::invalid_argument("position must be as long as time");
  }
  if (reach.velocity.size() != reach.time.size()) {
    throw std::invalid_argument("velocity must be as long as time");
  }
  if (!reach.force.empty() && reach.force.size() != reach.time.size()) {
    throw std::invalid_argument("force must be empty or as long as time");
  }
}

std::optional<Eigen::Vector3d> value_at(std::span<const double> time,
                                        std::span<const Eigen::Vector3d> values, double instant) {
  if (time.empty() || !(instant >= time.front() && instant <= time.back())) {
    return std::nullopt;
  }
  const auto after = std::ranges::upper_bound(time, instant);
  if (after == time.end()) {
    return values.back();
  }
  const auto i = static_cast<std::size_t>(after - time.begin());
  const double part = (instant - time[i - 1]) / (time[i] - time[i - 1]);
  return (1.0 - part) * values[i - 1] + part * values[i];
}

}  // namespace haptrial::analysis
