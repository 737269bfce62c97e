#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/bvh/bvh_kernel.h"
#include "core/geometry/bvh/bvh_split.h"
#include "core/geometry/bvh/flat_triangle.h"
#include "core/geometry/bvh/turned_box.h"

namespace haptrial::geometry {
namespace {

// From this depth on ranges are halved: what is below is less than kMaxDepth - kDeep deep.
constexpr int kDeep = 60;
// Boxes around more triangles than this stay upright: their surface is no longer near to flat.
constexpr std::uint32_t kTurned = 256;
// Ranges above this are divided one after the other, smaller ones side by side. It does not depend
// on the number of threads, so that the tree does not.
constexpr std::uint32_t kLarge = 16384;

/// Triangles from which the tree is built, in the frame.
struct Material {
  const Mesh& mesh;
  std::vector<Four> vertices;
  std::vector<Item> items;
  std::vector<Item> scratch;  // as many
};

/// Nodes, numbered from 0, and where each leaf's items begin and end.
struct Tree {
  std::vector<Node> nodes;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> leaves;
};

void write_box(const FourBox& box, Boxes& boxes, int place) {
  for (int axis = 0; axis < 3; ++axis) {
    boxes.low[axis][place] = box.low[axis];
    boxes.high[axis][place] = box.high[axis];
  }
}

void leave_empty(Boxes& boxes, int place) {
  for (int axis = 0; axis < 3; ++axis) {
    boxes.low[axis][place] = std::numeric_limits<float>::infinity();
    boxes.high[axis][place] = -std::numeric_limits<float>::infinity();
  }
}

/// Divides ranges and writes nodes.
class Builder {
 public:
  explicit Builder(Material& material) : material_(material), items_(material.items) {}

  Range whole() const { return range_of(items_, 0, static_cast<std::uint32_t>(items_.size())); }

  /// Up to sixteen parts of a range, each small enough to make a full subtree of the next lower
  /// height: the largest is split again and again. Parts that fit a leaf are left whole.
  int divide(const Range& range, int depth, std::array<Range, kWidth>& parts) {
    std::uint32_t enough = kWidth;
    while (enough * kFill < range.count()) {
      enough *= kFill;
    }
    parts[0] = range;
    int count = 1;
    while (count < kWidth) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + count,
                           [](const Range& a, const Range& b) { return a.count() < b.count(); });
      if (largest->count() <= enough) {
        break;
      }
      const auto [left, right] =
          depth < kDeep ? split(items_, material_.scratch, *largest) : halve(items_, *largest);
      *largest = left;
      parts[count++] = right;
    }
    return count;
  }

  void write_node(std::span<const Range> parts, Node& node) {
    for (int i = 0; i < kWidth; ++i) {
      node.child[i] = 0;
      if (i >= static_cast<int>(parts.size())) {
        leave_empty(node.boxes, i);
        leave_empty(node.turned, i);
        continue;
      }
      write_box(parts[i].box, node.boxes, i);
      if (parts[i].count() > kTurned) {
        write_upright(parts[i].box, node.turned, i);
      } else {
        write_turned(corners_of(parts[i]), parts[i].box, node.turned, i);
      }
    }
  }

  static bool is_leaf(const Range& range) { return range.count() <= kWidth; }

  /// The tree below `range`, its root first.
  void grow(const Range& range, int depth, Tree& tree) {
    const std::size_t at = tree.nodes.size();
    tree.nodes.emplace_back();
    std::array<Range, kWidth> parts;
    const int count = divide(range, depth, parts);
    write_node(std::span(parts).first(count), tree.nodes[at]);
    for (int i = 0; i < count; ++i) {
      if (is_leaf(parts[i])) {
        tree.nodes[at].child[i] = ~static_cast<std::int32_t>(tree.leaves.size());
        tree.leaves.emplace_back(parts[i].begin, parts[i].end);
      } else {
        tree.nodes[at].child[i] = static_cast<std::int32_t>(tree.nodes.size());
        grow(parts[i], depth + 1, tree);
      }
    }
  }

 private:
  static constexpr std::uint32_t kFill = 11;  // parts expected of a node

  std::span<const Four> corners_of(const Range& range) {
    for (std::uint32_t i = 0; i < range.count(); ++i) {
      const Triangle& t = material_.mesh.triangles[items_[range.begin + i].triangle()];
      for (int k = 0; k < 3; ++k) {
        corners_[3 * i + k] = material_.vertices[t[k]];
      }
    }
    return std::span<const Four>(corners_).first(3 * std::size_t{range.count()});
  }

  Material& material_;
  std::span<Item> items_;
  std::array<Four, 3 * kTurned> corners_;
};

/// The tree over everything: its top, and the subtrees grown apart from each other and then joined
/// in their order.
class Forest {
 public:
  Forest(Material& material, int threads) : material_(material), threads_(threads) {}

  Tree grow() {
    Builder builder(material_);
    tree_.nodes.emplace_back();
    open_.push_back({builder.whole(), 0, 0, 0});
    for (std::size_t i = 0; i < open_.size(); ++i) {
      grow_top(builder, open_[i]);
    }
    std::vector<Tree> trees(ripe_.size());
    parallel_for(trees.size(), threads_, [&](std::size_t i) {
      trees[i].nodes.reserve(ripe_[i].range.count() / 64 + 1);
      Builder(material_).grow(ripe_[i].range, ripe_[i].depth, trees[i]);
    });
    join(trees);
    return std::move(tree_);
  }

 private:
  struct Place {
    Range range;
    std::size_t node;  // where the range's node, or the child that names it, is
    int slot;
    int depth;
  };

  void grow_top(Builder& builder, Place place) {
    std::array<Range, kWidth> parts;
    const int count = builder.divide(place.range, place.depth, parts);
    builder.write_node(std::span(parts).first(count), tree_.nodes[place.node]);
    for (int i = 0; i < count; ++i) {
      std::int32_t& child = tree_.nodes[place.node].child[i];
      if (Builder::is_leaf(parts[i])) {
        child = ~static_cast<std::int32_t>(tree_.leaves.size());
        tree_.leaves.emplace_back(parts[i].begin, parts[i].end);
      } else if (parts[i].count() > kLarge) {
        child = static_cast<std::int32_t>(tree_.nodes.size());
        open_.push_back({parts[i], tree_.nodes.size(), 0, place.depth + 1});
        tree_.nodes.emplace_back();
      } else {
        ripe_.push_back({parts[i], place.node, i, place.depth + 1});
      }
    }
  }

  void join(const std::vector<Tree>& trees) {
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const auto first_node = static_cast<std::int32_t>(tree_.nodes.size());
      const auto first_leaf = static_cast<std::int32_t>(tree_.leaves.size());
      tree_.nodes[ripe_[i].node].child[ripe_[i].slot] = first_node;
      tree_.leaves.insert(tree_.leaves.end(), trees[i].leaves.begin(), trees[i].leaves.end());
      tree_.nodes.insert(tree_.nodes.end(), trees[i].nodes.begin(), trees[i].nodes.end());
      for (std::size_t n = first_node; n < tree_.nodes.size(); ++n) {
        for (std::int32_t& child : tree_.nodes[n].child) {
          if (child != 0) {
            child += child > 0 ? first_node : -first_leaf;
          }
        }
      }
    }
  }

  Material& material_;
  int threads_;
  Tree tree_;
  std::vector<Place> open_, ripe_;
};

constexpr double kFarthest = 1e100;  // squares of coordinates stay finite

void check(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!(mesh.vertices[i].cwiseAbs().maxCoeff() <= kFarthest) || !mesh.vertices[i].allFinite()) {
      throw InputError(
          fmt::format("vertex {} has a coordinate that is not finite or beyond 1e100; allowed: "
                      "finite numbers up to 1e100",
                      i));
    }
  }
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::int32_t corner : mesh.triangles[i]) {
      if (corner < 0 || corner >= count) {
        throw InputError(
            fmt::format("triangle {} names vertex {}; allowed: 0 to {}", i, corner, count - 1));
      }
    }
  }
}

Frame frame_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  Frame frame;
  frame.centre = 0.5 * box.min() + 0.5 * box.max();
  const double reach = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
  if (reach > 0.0) {
    frame.scale = std::ldexp(1.0, std::min(-std::ilogb(reach) - 1, 1000));
  }
  return frame;
}

Material make_material(const Mesh& mesh, const Frame& frame) {
  Material material{mesh, std::vector<Four>(mesh.vertices.size()),
                    std::vector<Item>(mesh.triangles.size()),
                    std::vector<Item>(mesh.triangles.size())};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = frame.to_frame(mesh.vertices[i]).cast<float>();
    material.vertices[i] = Four{p.x(), p.y(), p.z(), 0.0f};
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::int32_t k : mesh.triangles[i]) {
      material.items[i].box.add(material.vertices[k]);
    }
    material.items[i].set_triangle(static_cast<std::int32_t>(i));
  }
  return material;
}

void write_leaf(const Material& material, std::size_t at,
                std::pair<std::uint32_t, std::uint32_t> items, BvhData& data) {
  Corners* const corners = data.corners.data() + kWidth * at;
  std::int32_t* const ids = data.ids.data() + kWidth * at;
  const int count = static_cast<int>(items.second - items.first);
  for (int place = 0; place < count; ++place) {
    const Item& item = material.items[items.first + place];
    ids[place] = item.triangle();
    const Triangle& triangle = material.mesh.triangles[ids[place]];
    for (int k = 0; k < 3; ++k) {
      corners[place][k] = material.mesh.vertices[triangle[k]];
    }
    write_box(item.box, data.leaf_boxes[at], place);
    data.slots[ids[place]] = static_cast<std::int32_t>(kWidth * at) + place;
  }
  for (int place = count; place < kWidth; ++place) {
    ids[place] = -1;
    corners[place] = corners[0];
    leave_empty(data.leaf_boxes[at], place);
  }
  data.kernels->flatten(corners, data.frame, data.leaves[at]);
  for (int place = count; place < kWidth; ++place) {
    leave_empty(data.leaves[at], place);
  }
}

}  // namespace

void build_hierarchy(const Mesh& mesh, int threads, BvhData& data) {
  check(mesh);
  if (mesh.triangles.empty()) {
    return;
  }
  data.frame = frame_of(mesh);
  Material material = make_material(mesh, data.frame);
  Tree tree = Forest(material, threads).grow();
  data.nodes = std::move(tree.nodes);
  const std::size_t leaves = tree.leaves.size();
  data.leaves = Unset<Leaf>(leaves);
  data.leaf_boxes = Unset<Boxes>(leaves);
  data.corners = Unset<Corners>(kWidth * leaves);
  data.ids = Unset<std::int32_t>(kWidth * leaves);
  data.slots = Unset<std::int32_t>(mesh.triangles.size());
  constexpr std::size_t kBlock = 256;
  parallel_for((leaves + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(leaves, (block + 1) * kBlock); ++i) {
      write_leaf(material, i, tree.leaves[i], data);
    }
  });
}

}  // namespace haptrial::geometry
