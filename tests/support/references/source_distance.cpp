#include "tests/support/references/source_distance.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::geometry {

SourceDistance::SourceDistance(const Mesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    corners_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  }
  std::vector<std::int32_t> order(corners_.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * corners_.size());
  if (!order.empty()) {
    build(order, 0, order.size(), -1);
  }
}

/// Halves by the middles along the box's longest side.
std::int32_t SourceDistance::build(std::vector<std::int32_t>& order, std::size_t first,
                                   std::size_t last, std::int32_t parent) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Node node{Eigen::Vector3d::Constant(kInfinity),
            Eigen::Vector3d::Constant(-kInfinity),
            parent,
            -1,
            -1,
            order[first]};
  for (std::size_t i = first; i < last; ++i) {
    for (const Eigen::Vector3d& corner : corners_[order[i]]) {
      node.low = node.low.cwiseMin(corner);
      node.high = node.high.cwiseMax(corner);
    }
  }
  const auto at = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back(node);
  if (last - first == 1) {
    return at;
  }
  int axis = 0;
  (node.high - node.low).maxCoeff(&axis);
  const auto middle = [&](std::int32_t triangle) {
    const auto& c = corners_[triangle];
    return c[0][axis] + c[1][axis] + c[2][axis];
  };
  const std::size_t half = first + (last - first) / 2;
  const auto begin = order.begin();
  std::nth_element(begin + static_cast<std::ptrdiff_t>(first),
                   begin + static_cast<std::ptrdiff_t>(half),
                   begin + static_cast<std::ptrdiff_t>(last), [&](std::int32_t a, std::int32_t b) {
                     return middle(a) != middle(b) ? middle(a) < middle(b) : a < b;
                   });
  const std::int32_t left = build(order, first, half, at);
  const std::int32_t right = build(order, half, last, at);
  nodes_[at].left = left;
  nodes_[at].right = right;
  return at;
}

void SourceDistance::start(const Options& options) {
  options_ = options;
  counts_ = {};
  winner_ = -1;
}

ClosestPoint SourceDistance::closest(const Eigen::Vector3d& point) {
  best_ = {};
  lowest_upper_ = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) {
    return best_;
  }
  if (winner_ >= 0 && options_.ascend >= 0) {
    std::int32_t seed = winner_;
    for (int i = 0; i < options_.ascend && nodes_[seed].parent >= 0; ++i) {
      seed = nodes_[seed].parent;
    }
    to_descend_.push_back(seed);
  }
  to_descend_.push_back(0);
  while (!to_descend_.empty()) {
    const std::int32_t next = to_descend_.front();
    to_descend_.pop_front();
    process(next, point);
  }
  return best_;
}

void SourceDistance::process(std::int32_t at, const Eigen::Vector3d& point) {
  const Node& node = nodes_[at];
  if (node.left < 0) {
    ++counts_.triangles;
    const auto& c = corners_[node.triangle];
    ClosestPoint here = closest_on_triangle(point, c[0], c[1], c[2]);
    if (here.distance_squared < best_.distance_squared) {
      here.triangle = node.triangle;
      best_ = here;
      winner_ = at;
      lowest_upper_ = std::min(lowest_upper_, here.distance_squared);
    }
    return;
  }
  ++counts_.boxes;
  const Eigen::Vector3d below = node.low - point, above = point - node.high;
  const double lower = below.cwiseMax(above).cwiseMax(0.0).squaredNorm();
  const double upper = (-below).cwiseAbs().cwiseMax(above.cwiseAbs()).squaredNorm();
  // A box's bound and a triangle's distance are rounded apart from each other.
  if (lower > lowest_upper_ * (1.0 + 1e-12)) {
    return;
  }
  lowest_upper_ = std::min(lowest_upper_, upper);
  if (options_.depth_first) {
    to_descend_.push_front(node.left);
    to_descend_.push_front(node.right);
  } else {
    to_descend_.push_back(node.left);
    to_descend_.push_back(node.right);
  }
}

}  // namespace haptrial::geometry
