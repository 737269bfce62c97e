#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// Weight of a node in the value of a vertex.
struct NodeShare {
  std::int32_t used;  // place of the node in SpringGrid::used()
  double weight;
};

/// A coarse grid over the box of the rest vertices, whose values trilinear interpolation takes to
/// the vertices. An axis with one node has the same value along it.
/// Source: Morris 2006, §5.3.5.
class SpringGrid {
 public:
  /// @param nodes  along x, y and z, each at least 1
  /// @throws InputError for a grid without a node.
  SpringGrid(const SpringBody& body, const std::array<int, 3>& nodes);

  /// Nodes that some vertex depends on, in ascending order of x + nodes_x (y + nodes_y z). The
  /// others have no influence and no place in the lists of values below.
  const std::vector<std::int32_t>& used() const { return used_; }
  Eigen::Vector3d place(std::size_t used) const;  // of a used node [m]

  /// Weights of the used nodes in the value of a vertex; they sum to 1, and some may be 0.
  std::array<NodeShare, 8> shares(std::size_t vertex) const;

 private:
  std::array<int, 3> nodes_;
  Eigen::Vector3d low_, size_;
  std::vector<std::int32_t> used_;
  std::vector<std::array<std::int32_t, 8>> node_;  // by vertex: places in the list of used nodes
  std::vector<std::array<double, 8>> weight_;      // by vertex; they sum to 1
};

}  // namespace haptrial::deformable
