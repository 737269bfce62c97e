#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// The source's own search for nearest points, as a reference to compare with: a binary tree of
/// boxes with a triangle in each leaf, one list of boxes still to descend, and for the next voxel a
/// start near the leaf that won. What the printed listing has wrong is mended: bounds are squared
/// Euclidean distances, minima are reset for every point, and the root is searched after the seed.
/// It counts what it does, so that its behaviour can be studied on any machine.
/// Source: Morris 2006, §6.3.3.
class SourceDistance {
 public:
  struct Options {
    int ascend{0};           // TREE_ASCEND_N: levels up from the last winner; -1: no seed
    bool depth_first{true};  // else breadth first
  };
  struct Counts {
    std::uint64_t boxes{0};      // whose bounds were computed
    std::uint64_t triangles{0};  // whose distances were computed
  };

  explicit SourceDistance(const Mesh& mesh);

  /// Forgets the last winner and what was counted.
  void start(const Options& options);
  ClosestPoint closest(const Eigen::Vector3d& point);
  const Counts& counts() const { return counts_; }

 private:
  struct Node {
    Eigen::Vector3d low, high;
    std::int32_t parent, left, right;  // left < 0: a leaf
    std::int32_t triangle;
  };
  std::int32_t build(std::vector<std::int32_t>& order, std::size_t first, std::size_t last,
                     std::int32_t parent);
  void process(std::int32_t node, const Eigen::Vector3d& point);

  std::vector<std::array<Eigen::Vector3d, 3>> corners_;
  std::vector<Node> nodes_;  // the root first
  Options options_;
  Counts counts_;
  std::deque<std::int32_t> to_descend_;
  ClosestPoint best_;
  double lowest_upper_{0.0};  // squared [m²]
  std::int32_t winner_{-1};   // the last nearest leaf
};

}  // namespace haptrial::geometry
