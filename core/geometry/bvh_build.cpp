#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/base/error.h"
#include "core/geometry/bvh_data.h"
#include "core/geometry/flat_triangle.h"
#include "core/geometry/four.h"
#include "core/geometry/parallel.h"

namespace haptrial::geometry {
namespace {

/// A triangle while the tree is built: its box, its number in the fourth place of `low`.
struct Item {
  FourBox box;
  std::int32_t triangle() const { return std::bit_cast<FourInts>(box.low)[3]; }
  /// Twice the middle of the box.
  Four middle() const { return box.low + box.high; }
};

/// Consecutive items, the hull of their boxes and that of their middles.
struct Range {
  std::uint32_t begin{0}, end{0};
  FourBox box, middles;
  std::uint32_t count() const { return end - begin; }
  void add(const Item& item) {
    box.add(item.box);
    middles.add(item.middle());
  }
};

constexpr int kBins = 16;
// From here on ranges are halved: the rest of the tree is less than kMaxDepth - kDeep deep.
constexpr int kDeep = 60;

/// Bins along the three axes at once.
struct Bins {
  FourBox box[3][kBins];
  std::uint32_t count[3][kBins]{};
};

/// Which bin a middle falls in, for each axis.
class Binning {
 public:
  explicit Binning(const FourBox& middles) : low_(middles.low) {
    for (int axis = 0; axis < 3; ++axis) {
      const float side = middles.high[axis] - middles.low[axis];
      scale_[axis] = side > 0.0f ? kBins * 0.99999f / side : 0.0f;
    }
  }
  FourInts operator()(Four middle) const {
    return __builtin_convertvector((middle - low_) * scale_, FourInts);
  }
  bool splits(int axis) const { return scale_[axis] > 0.0f && std::isfinite(scale_[axis]); }

 private:
  Four low_;
  Four scale_{0.0f, 0.0f, 0.0f, 0.0f};
};

struct Split {
  int axis{-1};  // -1: the middles all coincide
  int bin{0};    // the first bin of the right part
};

/// The split of least area times count.
Split best_split(const Bins& bins, const Binning& binning) {
  Split best;
  float least = 3e38f;
  for (int axis = 0; axis < 3; ++axis) {
    if (!binning.splits(axis)) continue;
    std::array<float, kBins> right_cost{};
    FourBox hull;
    std::uint32_t count = 0;
    for (int bin = kBins - 1; bin > 0; --bin) {
      hull.add(bins.box[axis][bin]);
      count += bins.count[axis][bin];
      right_cost[bin] = count == 0 ? 0.0f : hull.half_area() * static_cast<float>(count);
    }
    hull = FourBox();
    count = 0;
    for (int bin = 1; bin < kBins; ++bin) {
      hull.add(bins.box[axis][bin - 1]);
      count += bins.count[axis][bin - 1];
      const float cost =
          right_cost[bin] + (count == 0 ? 0.0f : hull.half_area() * static_cast<float>(count));
      if (count > 0 && right_cost[bin] >= 0.0f && cost < least) {
        least = cost;
        best = {axis, bin};
      }
    }
  }
  return best;
}

/// Builds one tree over items that it sorts; its nodes are numbered from 0.
class Builder {
 public:
  explicit Builder(std::span<Item> items) : items_(items) {}

  std::size_t size() const { return items_.size(); }

  Range range(std::uint32_t begin, std::uint32_t end) const {
    Range range{begin, end, {}, {}};
    for (std::uint32_t i = begin; i < end; ++i) range.add(items_[i]);
    return range;
  }

  /// Up to sixteen parts of a range: the one of the largest surface is split again and again.
  /// Parts of sixteen triangles or fewer are left whole; a range of so few becomes single
  /// triangles.
  int divide(const Range& whole, int depth, std::array<Range, kWidth>& parts) {
    if (whole.count() <= kWidth) {
      for (std::uint32_t i = whole.begin; i < whole.end; ++i) {
        parts[i - whole.begin] = range(i, i + 1);
      }
      return static_cast<int>(whole.count());
    }
    parts[0] = whole;
    int count = 1;
    while (count < kWidth) {
      int widest = -1;
      float area = -1.0f;
      for (int i = 0; i < count; ++i) {
        if (parts[i].count() <= kWidth) continue;
        const float this_area = parts[i].box.half_area();
        if (this_area > area) {
          area = this_area;
          widest = i;
        }
      }
      if (widest < 0) break;
      const auto [left, right] = depth < kDeep ? split(parts[widest]) : halve(parts[widest]);
      parts[widest] = left;
      parts[count++] = right;
    }
    return count;
  }

  /// The tree below `whole`, its root first.
  void grow(const Range& whole, int depth, std::vector<Node>& nodes) {
    const std::size_t at = nodes.size();
    nodes.emplace_back();
    std::array<Range, kWidth> parts;
    const int count = divide(whole, depth, parts);
    write_boxes(std::span(parts).first(count), nodes[at]);
    for (int i = 0; i < count; ++i) {
      if (parts[i].count() == 1) {
        nodes[at].child[i] = ~static_cast<std::int32_t>(parts[i].begin);
      } else {
        nodes[at].child[i] = static_cast<std::int32_t>(nodes.size());
        grow(parts[i], depth + 1, nodes);
      }
    }
  }

  static void write_boxes(std::span<const Range> parts, Node& node) {
    for (int axis = 0; axis < 3; ++axis) {
      std::fill_n(node.low[axis], kWidth, std::numeric_limits<float>::infinity());
      std::fill_n(node.high[axis], kWidth, -std::numeric_limits<float>::infinity());
      for (std::size_t i = 0; i < parts.size(); ++i) {
        node.low[axis][i] = parts[i].box.low[axis];
        node.high[axis][i] = parts[i].box.high[axis];
      }
    }
    std::fill_n(node.child, kWidth, 0);
  }

 private:
  std::pair<Range, Range> split(const Range& whole) {
    const Binning binning(whole.middles);
    Bins bins;
    for (std::uint32_t i = whole.begin; i < whole.end; ++i) {
      const FourInts bin = binning(items_[i].middle());
      for (int axis = 0; axis < 3; ++axis) {
        bins.box[axis][bin[axis]].add(items_[i].box);
        ++bins.count[axis][bin[axis]];
      }
    }
    const Split best = best_split(bins, binning);
    return best.axis < 0 ? halve(whole) : part(whole, binning, best);
  }

  std::pair<Range, Range> halve(const Range& whole) const {
    const std::uint32_t middle = whole.begin + whole.count() / 2;
    return {range(whole.begin, middle), range(middle, whole.end)};
  }

  std::pair<Range, Range> part(const Range& whole, const Binning& binning, Split at) {
    Range left{whole.begin, whole.begin, {}, {}}, right{whole.end, whole.end, {}, {}};
    while (left.end < right.begin) {
      Item& item = items_[left.end];
      if (binning(item.middle())[at.axis] < at.bin) {
        left.add(item);
        ++left.end;
      } else {
        right.add(item);
        std::swap(item, items_[--right.begin]);
      }
    }
    return {left, right};
  }

  std::span<Item> items_;
};

constexpr double kFarthest = 1e100;  // squares of coordinates stay finite

void check(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!(mesh.vertices[i].cwiseAbs().maxCoeff() <= kFarthest) || !mesh.vertices[i].allFinite()) {
      throw InputError(
          fmt::format("vertex {} has a coordinate that is not finite or beyond 1e100; "
                      "allowed: finite coordinates of ordinary size",
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
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  Frame frame;
  if (box.isEmpty()) return frame;
  frame.centre = 0.5 * box.min() + 0.5 * box.max();
  const double reach = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
  if (reach > 0.0) frame.scale = std::ldexp(1.0, std::min(-std::ilogb(reach) - 1, 1000));
  return frame;
}

std::vector<Item> make_items(const Mesh& mesh, const Frame& frame) {
  std::vector<Four> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f p = frame.to_frame(mesh.vertices[i]).cast<float>();
    vertices[i] = Four{p.x(), p.y(), p.z(), 0.0f};
  }
  std::vector<Item> items(mesh.triangles.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    FourBox box;
    for (const std::int32_t corner : mesh.triangles[i]) box.add(vertices[corner]);
    auto bits = std::bit_cast<FourInts>(box.low);
    bits[3] = static_cast<std::int32_t>(i);
    box.low = std::bit_cast<Four>(bits);
    items[i].box = box;
  }
  return items;
}

/// The nodes over many ranges, grown apart from each other and then joined in their order.
class Forest {
 public:
  Forest(std::span<Item> items, int threads) : builder_(items), threads_(threads) {}

  std::vector<Node> grow() {
    const auto count = static_cast<std::uint32_t>(builder_.size());
    nodes_.emplace_back();
    open_.push_back({builder_.range(0, count), 0, 0, 0});
    for (std::size_t i = 0; i < open_.size(); ++i) grow_top(open_[i]);
    std::vector<std::vector<Node>> trees(ripe_.size());
    parallel_for(trees.size(), threads_, [&](std::size_t i) {
      trees[i].reserve(ripe_[i].range.count() / 6 + 1);
      builder_.grow(ripe_[i].range, ripe_[i].depth, trees[i]);
    });
    join(trees);
    return std::move(nodes_);
  }

 private:
  // Ranges above this are divided one after the other, smaller ones side by side. It does not
  // depend on the number of threads, so that the tree does not.
  static constexpr std::uint32_t kLarge = 16384;

  struct Place {
    Range range;
    std::size_t node;  // where the range's node, or the child that names it, is
    int slot;
    int depth;
  };

  void grow_top(Place place) {
    std::array<Range, kWidth> parts;
    const int count = builder_.divide(place.range, place.depth, parts);
    Builder::write_boxes(std::span(parts).first(count), nodes_[place.node]);
    for (int i = 0; i < count; ++i) {
      if (parts[i].count() == 1) {
        nodes_[place.node].child[i] = ~static_cast<std::int32_t>(parts[i].begin);
      } else if (parts[i].count() > kLarge) {
        nodes_[place.node].child[i] = static_cast<std::int32_t>(nodes_.size());
        open_.push_back({parts[i], nodes_.size(), 0, place.depth + 1});
        nodes_.emplace_back();
      } else {
        ripe_.push_back({parts[i], place.node, i, place.depth + 1});
      }
    }
  }

  void join(const std::vector<std::vector<Node>>& trees) {
    std::size_t total = nodes_.size();
    for (const auto& tree : trees) total += tree.size();
    nodes_.reserve(total);
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const auto first = static_cast<std::int32_t>(nodes_.size());
      nodes_[ripe_[i].node].child[ripe_[i].slot] = first;
      for (Node node : trees[i]) {
        for (std::int32_t& child : node.child) child += child > 0 ? first : 0;
        nodes_.push_back(node);
      }
    }
  }

  Builder builder_;
  int threads_;
  std::vector<Node> nodes_;
  std::vector<Place> open_, ripe_;
};

void write_slots(const Mesh& mesh, const std::vector<Item>& items, int threads, Bvh::Data& data) {
  const std::size_t count = items.size();
  data.flat.resize(count);
  data.corners.resize(count);
  data.ids.resize(count);
  data.slots.resize(count);
  constexpr std::size_t kBlock = 4096;
  parallel_for((count + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      const std::int32_t id = items[i].triangle();
      const Triangle& triangle = mesh.triangles[id];
      data.ids[i] = id;
      data.slots[id] = static_cast<std::int32_t>(i);
      for (int k = 0; k < 3; ++k) data.corners[i][k] = mesh.vertices[triangle[k]];
      data.flat[i] = flatten(data.corners[i], data.frame);
    }
  });
}

}  // namespace

void build_hierarchy(const Mesh& mesh, int threads, Bvh::Data& data) {
  check(mesh);
  if (mesh.triangles.empty()) return;
  data.frame = frame_of(mesh);
  std::vector<Item> items = make_items(mesh, data.frame);
  data.nodes = Forest(items, threads).grow();
  write_slots(mesh, items, threads, data);
}

}  // namespace haptrial::geometry
