#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/contact/contact_surface.h"
#include "core/geometry/bvh/bvh_data.h"
#include "core/geometry/mesh/four.h"

namespace haptrial::contact {
namespace {

using geometry::all_four;
using geometry::bits;
using geometry::Boxes;
using geometry::BvhData;
using geometry::Four;
using geometry::kWidth;
using geometry::larger;
using Lanes = std::array<float, kWidth>;

/// Boxes and queries are rounded to single precision: by less than this part of their coordinates.
constexpr double kRounded = 1e-6;

Four load(const float* from) {
  Four x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

void store(float* to, Four x) { std::memcpy(to, &x, sizeof x); }

Four absolute(Four x) { return larger(x, -x); }

/// Squared distances from a point to the boxes of a node; infinite for empty places.
/// @returns a bit for each that is within `limit`
unsigned squared_distances(const Boxes& boxes, const Four (&q)[3], float limit, Lanes& out) {
  unsigned within = 0;
  for (int i = 0; i < kWidth; i += 4) {
    Four sum = all_four(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      const Four below = load(boxes.low[axis] + i) - q[axis];
      const Four above = q[axis] - load(boxes.high[axis] + i);
      const Four apart = larger(larger(below, above), all_four(0.0f));
      sum += apart * apart;
    }
    store(out.data() + i, sum);
    within |= bits(sum <= all_four(limit)) << i;
  }
  return within;
}

/// A segment for boxes, in the frame of the hierarchy.
struct Rod {
  Four middle[3], half[3], reach[3];  // reach: |half|
  Four widen;

  Rod(const Eigen::Vector3d& from, const Eigen::Vector3d& move, double end, double radius) {
    const Eigen::Vector3d half_move = 0.5 * end * move;
    const Eigen::Vector3d at = from + half_move;
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = all_four(static_cast<float>(at[axis]));
      half[axis] = all_four(static_cast<float>(half_move[axis]));
      reach[axis] = absolute(half[axis]);
    }
    const double largest =
        std::max(from.cwiseAbs().maxCoeff(), (from + end * move).cwiseAbs().maxCoeff());
    widen = all_four(static_cast<float>(radius + kRounded * (1.0 + radius + largest)));
  }

  /// A bit for each box that the widened segment may meet: by separating axes.
  unsigned meets(const Boxes& boxes) const {
    unsigned met = 0;
    for (int i = 0; i < kWidth; i += 4) {
      Four d[3], e[3], most = all_four(-1.0f);
      for (int axis = 0; axis < 3; ++axis) {
        const Four low = load(boxes.low[axis] + i), high = load(boxes.high[axis] + i);
        d[axis] = all_four(0.5f) * (low + high) - middle[axis];
        e[axis] = all_four(0.5f) * (high - low) + widen;
        most = larger(absolute(d[axis]) - e[axis] - reach[axis], most);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const int y = (axis + 1) % 3, z = (axis + 2) % 3;
        const Four across = absolute(d[y] * half[z] - d[z] * half[y]);
        most = larger(across - e[y] * reach[z] - e[z] * reach[y], most);
      }
      const Four filled = load(boxes.low[0] + i);
      met |= bits((most <= 0.0f) & (filled < std::numeric_limits<float>::infinity())) << i;
    }
    return met;
  }
};

/// Asks for the boxes of a node that will be looked at soon: they come from far, several at once.
void fetch_early(const BvhData& data, std::int32_t node) {
  const Boxes& boxes = node < 0 ? data.leaf_boxes[~node] : data.nodes[node].boxes;
  for (int axis = 0; axis < 3; ++axis) {
    __builtin_prefetch(boxes.low[axis]);
    __builtin_prefetch(boxes.high[axis]);
  }
  if (node >= 0) {
    __builtin_prefetch(data.nodes[node].child);
  }
}

struct Child {
  float entry;  // about how far along the segment it begins
  std::int32_t place;
};

/// The children of a node that the widened segment may meet.
int met_children(const Rod& rod, const Boxes& boxes, const Eigen::Vector3f& direction,
                 std::array<Child, kWidth>& children) {
  int count = 0;
  for (unsigned met = rod.meets(boxes); met != 0; met &= met - 1) {
    const int i = std::countr_zero(met);
    float entry = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      entry +=
          direction[axis] * (direction[axis] > 0.0f ? boxes.low[axis][i] : boxes.high[axis][i]);
    }
    children[count++] = {entry, i};
  }
  return count;
}

/// A point and a reach for boxes, in the frame of the hierarchy.
struct Ball {
  Four centre[3];
  double rounded;  // off by less
  float limit;     // of squared distances

  Ball(const Eigen::Vector3d& at, double reach)
      : centre{all_four(static_cast<float>(at.x())), all_four(static_cast<float>(at.y())),
               all_four(static_cast<float>(at.z()))},
        rounded(kRounded * (1.0 + at.cwiseAbs().maxCoeff())) {
    const double within = reach + rounded;
    limit = static_cast<float>(std::min(within * within * 1.0001, 1e38));
  }
  /// No part of what is in a box is nearer.
  double apart(float square) const {
    const double distance = std::sqrt(static_cast<double>(square)) * (1.0 - kRounded) - rounded;
    return std::max(distance, 0.0);
  }
};

}  // namespace

int ContactSurface::gather(const Eigen::Vector3d& centre, double reach,
                           std::span<NearTriangle> found) const noexcept {
  const BvhData& data = bvh_.data();
  if (data.nodes.empty() || !centre.allFinite()) {
    return 0;
  }
  const Ball ball(data.frame.to_frame(centre), reach * data.frame.scale);
  std::array<std::int32_t, geometry::kMaxDepth * kWidth> stack;
  std::array<std::int32_t, 64> leaves;  // looked at when they have come from memory
  int top = 0, waiting = 0;
  std::size_t count = 0;
  stack[top++] = 0;
  Lanes squares;
  const auto look_at_leaves = [&] {
    for (int k = 0; k < waiting; ++k) {
      const std::int32_t leaf = leaves[k];
      unsigned within = squared_distances(data.leaf_boxes[leaf], ball.centre, ball.limit, squares);
      for (; within != 0; within &= within - 1) {
        if (count == found.size()) {
          return false;
        }
        const int i = std::countr_zero(within);
        const std::int32_t slot = leaf * kWidth + i;
        found[count++] = {ball.apart(squares[i]) / data.frame.scale, slot};
        __builtin_prefetch(&corners_[slot]);
        __builtin_prefetch(&corners_[slot][2].z());
        __builtin_prefetch(&normals_[slot]);
      }
    }
    waiting = 0;
    return true;
  };
  while (top > 0) {
    const geometry::Node& node = data.nodes[stack[--top]];
    unsigned within = squared_distances(node.boxes, ball.centre, ball.limit, squares);
    for (; within != 0; within &= within - 1) {
      const std::int32_t child = node.child[std::countr_zero(within)];
      fetch_early(data, child);
      if (child >= 0) {
        stack[top++] = child;
        continue;
      }
      if (waiting == static_cast<int>(leaves.size()) && !look_at_leaves()) {
        return -1;
      }
      leaves[waiting++] = ~child;
    }
  }
  return look_at_leaves() ? static_cast<int>(count) : -1;
}

void ContactSurface::along(const Eigen::Vector3d& from, const Eigen::Vector3d& move, double radius,
                           Visit visit, void* context) const noexcept {
  const BvhData& data = bvh_.data();
  if (data.nodes.empty() || !from.allFinite() || !move.allFinite()) {
    return;
  }
  const Eigen::Vector3d start = data.frame.to_frame(from), way = move * data.frame.scale;
  const double width = radius * data.frame.scale;
  double end = 1.0;
  Rod rod(start, way, end, width);
  const Eigen::Vector3f direction = way.stableNormalized().cast<float>();
  std::array<std::int32_t, geometry::kMaxDepth * kWidth> stack;
  int top = 0;
  stack[top++] = 0;
  std::array<Child, kWidth> children;
  while (top > 0) {
    const std::int32_t node = stack[--top];
    const Boxes& boxes = node < 0 ? data.leaf_boxes[~node] : data.nodes[node].boxes;
    const int count = met_children(rod, boxes, direction, children);
    std::sort(children.begin(), children.begin() + count, [&](const Child& a, const Child& b) {
      return node < 0 ? a.entry < b.entry : a.entry > b.entry;  // the stack turns the order round
    });
    for (int i = 0; i < count; ++i) {
      if (node >= 0) {
        stack[top++] = data.nodes[node].child[children[i].place];
        fetch_early(data, stack[top - 1]);
        continue;
      }
      const double left = visit(context, ~node * kWidth + children[i].place);
      if (left < end) {
        end = left;
        rod = Rod(start, way, end, width);
      }
    }
  }
}

}  // namespace haptrial::contact
