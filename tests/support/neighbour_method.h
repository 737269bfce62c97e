#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/control/sampled_curve.h"

namespace haptrial::test {

/// A curve as the source stores it, and its way of finding the place that belongs to a tool: among
/// the segments that touch the N points nearest to it, the one of the lowest
///
///     distance + weight · |arc - arc before|,    arc from 0 to 1 over the curve
///
/// with both of its listing's slips mended: a point brings in both segments that touch it, and the
/// arc position runs with t. Source: Morris 2006, §6.2.2.
class NeighbourMethod {
 public:
  explicit NeighbourMethod(std::vector<Eigen::Vector3d> points)
      : points_(std::move(points)), arc_(points_.size(), 0.0) {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      arc_[i] = arc_[i - 1] + (points_[i] - points_[i - 1]).norm();
    }
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  double length() const { return arc_.back(); }

  /// @param neighbours  indices of the N nearest points, in any order
  /// @param before      arc position of the place before [m]; nothing at the start
  control::CurvePlace place(const Eigen::Vector3d& tool, std::span<const std::uint32_t> neighbours,
                            std::optional<double> before, double weight) {
    candidates_.clear();
    for (const std::uint32_t i : neighbours) {
      if (i > 0) {
        candidates_.push_back(i - 1);
      }
      if (i + 1 < points_.size()) {
        candidates_.push_back(i);
      }
    }
    std::sort(candidates_.begin(), candidates_.end());
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
    control::CurvePlace best;
    double lowest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : candidates_) {
      const control::CurvePlace here = on_segment(tool, i);
      const double apart = before ? std::abs(here.arc - *before) / length() : 0.0;
      if (here.distance + weight * apart < lowest) {
        lowest = here.distance + weight * apart;
        best = here;
      }
    }
    return best;
  }

  /// The N nearest points by looking at every one.
  std::vector<std::uint32_t> nearest_points(const Eigen::Vector3d& tool, std::size_t n) const {
    std::vector<std::uint32_t> order(points_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      order[i] = i;
    }
    n = std::min(n, order.size());
    const auto nearer = [&](std::uint32_t a, std::uint32_t b) {
      return (points_[a] - tool).squaredNorm() < (points_[b] - tool).squaredNorm();
    };
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n), order.end(),
                      nearer);
    order.resize(n);
    return order;
  }

 private:
  control::CurvePlace on_segment(const Eigen::Vector3d& tool, std::uint32_t i) const {
    const Eigen::Vector3d chord = points_[i + 1] - points_[i];
    const double square = chord.squaredNorm();
    const double t =
        square > 0.0 ? std::clamp((tool - points_[i]).dot(chord) / square, 0.0, 1.0) : 0.0;
    control::CurvePlace place;
    place.segment = i;
    place.t = t;
    place.arc = arc_[i] * (1.0 - t) + arc_[i + 1] * t;
    place.position = points_[i] + t * chord;
    place.distance = (tool - place.position).norm();
    return place;
  }

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> arc_;
  std::vector<std::uint32_t> candidates_;
};

}  // namespace haptrial::test
