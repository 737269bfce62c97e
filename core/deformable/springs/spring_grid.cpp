#include "core/deformable/springs/spring_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

/// Place of a coordinate between two nodes of an axis.
struct AxisPlace {
  int low, high;
  double share;  // of `high`
};

AxisPlace along_axis(double share, int nodes) {
  if (nodes == 1) {
    return {0, 0, 0.0};
  }
  const double at = share * (nodes - 1);
  const int low = std::clamp(static_cast<int>(std::floor(at)), 0, nodes - 2);
  return {low, low + 1, std::clamp(at - low, 0.0, 1.0)};
}

/// The eight nodes around a place and their weights.
struct Corners {
  std::array<std::int32_t, 8> node;
  std::array<double, 8> weight;
};

/// @param share  of the box's size, along each axis
Corners corners_at(const Vector3d& share, const std::array<int, 3>& nodes) {
  const std::array<AxisPlace, 3> at{along_axis(share.x(), nodes[0]),
                                    along_axis(share.y(), nodes[1]),
                                    along_axis(share.z(), nodes[2])};
  Corners corners{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::array<int, 3> index{};
    corners.weight[corner] = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool up = (corner >> axis & 1) != 0;
      index[axis] = up ? at[axis].high : at[axis].low;
      corners.weight[corner] *= up ? at[axis].share : 1 - at[axis].share;
    }
    corners.node[corner] = index[0] + nodes[0] * (index[1] + nodes[1] * index[2]);
  }
  return corners;
}

}  // namespace

SpringGrid::SpringGrid(const SpringBody& body, const std::array<int, 3>& nodes) : nodes_(nodes) {
  if (*std::min_element(nodes.begin(), nodes.end()) < 1) {
    throw InputError(
        fmt::format("grid of constants: {} x {} x {} nodes; at least 1 along each axis", nodes[0],
                    nodes[1], nodes[2]));
  }
  low_ = body.rest.front();
  Vector3d high = low_;
  for (const Vector3d& p : body.rest) {
    low_ = low_.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  size_ = high - low_;
  for (const Vector3d& p : body.rest) {
    const auto [node, weight] = corners_at((p - low_).cwiseQuotient(size_), nodes);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if (weight[corner] > 0) {
        used_.push_back(node[corner]);
      }
    }
    node_.push_back(node);
    weight_.push_back(weight);
  }
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  for (auto& node : node_) {
    for (std::int32_t& n : node) {
      // A node of weight 0 may be absent: any place serves it.
      const auto found = std::lower_bound(used_.begin(), used_.end(), n);
      n = found == used_.end() ? 0 : static_cast<std::int32_t>(found - used_.begin());
    }
  }
}

Vector3d SpringGrid::place(std::size_t used) const {
  const int node = used_[used];
  const std::array<int, 3> index{node % nodes_[0], node / nodes_[0] % nodes_[1],
                                 node / (nodes_[0] * nodes_[1])};
  Vector3d place = low_ + 0.5 * size_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (nodes_[axis] > 1) {
      place[a] = low_[a] + size_[a] * index[axis] / (nodes_[axis] - 1);
    }
  }
  return place;
}

std::array<NodeShare, 8> SpringGrid::shares(std::size_t vertex) const {
  std::array<NodeShare, 8> shares{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    shares[corner] = {node_[vertex][corner], weight_[vertex][corner]};
  }
  return shares;
}

}  // namespace haptrial::deformable
