#include "core/deformable/body/nearest_points.h"

#include <algorithm>
#include <numeric>

namespace haptrial::deformable {

NearestPoints::NearestPoints(std::vector<Eigen::Vector3d> points)
    : points_(std::move(points)), order_(points_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  split(0, order_.size(), 0);
}

void NearestPoints::split(std::size_t first, std::size_t last, int axis) {
  if (last - first < 2) {
    return;
  }
  const std::size_t middle = (first + last) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::int32_t a, std::int32_t b) {
    return points_[static_cast<std::size_t>(a)][axis] < points_[static_cast<std::size_t>(b)][axis];
  });
  split(first, middle, (axis + 1) % 3);
  split(middle + 1, last, (axis + 1) % 3);
}

void NearestPoints::find(const Eigen::Vector3d& place, std::size_t count,
                         std::vector<NearPoint>& nearest) const {
  nearest.clear();
  search(place, std::min(count, points_.size()), 0, order_.size(), 0, nearest);
}

void NearestPoints::search(const Eigen::Vector3d& place, std::size_t count, std::size_t first,
                           std::size_t last, int axis, std::vector<NearPoint>& nearest) const {
  if (first == last) {
    return;
  }
  const std::size_t middle = (first + last) / 2;
  const std::int32_t number = order_[middle];
  const Eigen::Vector3d& point = points_[static_cast<std::size_t>(number)];
  const NearPoint here{(place - point).squaredNorm(), number};
  if (nearest.size() < count || here < nearest.back()) {
    if (nearest.size() == count) {
      nearest.pop_back();
    }
    nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), here), here);
  }
  const double beyond = place[axis] - point[axis];
  const int next = (axis + 1) % 3;
  const auto low = [&] { search(place, count, first, middle, next, nearest); };
  const auto high = [&] { search(place, count, middle + 1, last, next, nearest); };
  beyond < 0 ? low() : high();
  if (nearest.size() < count || beyond * beyond <= nearest.back().square) {
    beyond < 0 ? high() : low();
  }
}

}  // namespace haptrial::deformable
