#pragma once

// The searches for nearest points, written once for every instruction set. Included by the kernel
// files after their target pragma; Lanes and Doubles are the vector types of that file.
//
// Both go the same way. A descent in single precision keeps the least distance seen so far; what it
// may be wrong by, `error`, is known, so that no triangle farther than that distance + 2 error can
// be the nearest. Those within are put down, and measured in double precision in the end.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/geometry/bvh/bvh_kernel.h"
#include "core/geometry/bvh/flat_triangle.h"
#include "core/geometry/mesh/triangle_distance_lanes.h"

namespace haptrial::geometry::kernel {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::max();
constexpr int kStackSize = kMaxDepth * kWidth;

/// (distance + 2 error)².
[[gnu::always_inline]] inline float widened(float distance_squared, float error) {
  const float limit = std::sqrt(distance_squared) + 2.0f * error;
  return std::min(limit * limit, kUnbounded);
}

/// The points that a search is about, seen by boxes: a box along the axes around them.
struct Extent {
  float middle[3];
  float half[3];  // 0 for a single point
};

/// Squared distances from the children's boxes to an extent, or less than that.
/// @returns a bit for each child within `limit`.
template <class Lanes, bool kSpread>
[[gnu::always_inline]] inline unsigned boxes_within(const TurnedBoxes& boxes, const Extent& from,
                                                    float limit, float distances[kWidth]) {
  using Number = typename Lanes::Number;
  unsigned within = 0;
  const Number zero = Lanes::all(0.0f);
  for (int first = 0; first < kWidth; first += Lanes::kCount) {
    Number sum = zero;
    for (int axis = 0; axis < 3; ++axis) {
      Number at = Lanes::load(boxes.row[axis][3] + first);
      Number half = Lanes::load(boxes.half[axis] + first);
      for (int k = 0; k < 3; ++k) {
        const Number row = Lanes::load(boxes.row[axis][k] + first);
        at = Lanes::fma(row, Lanes::all(from.middle[k]), at);
        if (kSpread) {
          half = Lanes::fma(Lanes::absolute(row), Lanes::all(from.half[k]), half);
        }
      }
      const Number outside = Lanes::larger(Lanes::absolute(at) - half, zero);
      sum = Lanes::fma(outside, outside, sum);
    }
    Lanes::store(distances + first, sum);
    within |= Lanes::bits(Lanes::less_equal(sum, Lanes::all(limit))) << first;
  }
  return within;
}

/// Squared distances from one point to the triangles of a leaf.
/// @returns a bit for each triangle within `limit`.
template <class Lanes>
[[gnu::always_inline]] inline unsigned triangles_within(const Leaf& leaf, const float p[3],
                                                        float limit, float distances[kWidth]) {
  unsigned within = 0;
  for (int first = 0; first < kWidth; first += Lanes::kCount) {
    const auto found = flat_distance_squared<Lanes>(
        leaf, [first](const float* values) { return Lanes::load(values + first); },
        Lanes::all(p[0]), Lanes::all(p[1]), Lanes::all(p[2]));
    Lanes::store(distances + first, found);
    within |= Lanes::bits(Lanes::less_equal(found, Lanes::all(limit))) << first;
  }
  return within;
}

/// Children in the order in which they will be searched: the nearest on top.
struct Stack {
  struct Entry {
    float bound;          // squared distance to the box
    std::int32_t parent;  // whose child it is
    std::int32_t place;   // and which
  };
  Entry entries[kStackSize];
  int size{0};

  bool empty() const { return size == 0; }
  Entry pop() { return entries[--size]; }
  /// Children of a node within the limit, the nearest on top, the others as they come.
  [[gnu::always_inline]] void push(std::int32_t node, unsigned within,
                                   const float distances[kWidth]) {
    if (within == 0) {
      return;
    }
    int nearest = size;
    for (; within != 0; within &= within - 1) {
      const int i = std::countr_zero(within);
      entries[size] = {distances[i], node, i};
      if (distances[i] < entries[nearest].bound) {
        nearest = size;
      }
      ++size;
    }
    std::swap(entries[nearest], entries[size - 1]);
  }
};

/// Measures pairs of a point and a triangle in double precision, several at a time.
template <class Doubles>
class Exact {
  static constexpr int kCount = Doubles::kCount;

 public:
  explicit Exact(const BvhData& data) : data_(data) {}

  /// The answer goes into *best when it is the nearer one, at the latest in finish().
  [[gnu::always_inline]] void add(const Eigen::Vector3d& point, std::int32_t slot,
                                  ClosestPoint* best) {
    const Corners& corners = data_.corners[slot];
    for (int axis = 0; axis < 3; ++axis) {
      values_[axis][used_] = point[axis];
      for (int k = 0; k < 3; ++k) {
        values_[3 + 3 * k + axis][used_] = corners[k][axis];
      }
    }
    slots_[used_] = slot;
    best_[used_] = best;
    if (++used_ == kCount) {
      measure();
    }
  }
  void finish() {
    if (used_ > 0) {
      measure();
    }
  }

 private:
  void measure() {
    const auto at = [&](int row) {
      return Lanes3<Doubles>{Doubles::load(values_[row]), Doubles::load(values_[row + 1]),
                             Doubles::load(values_[row + 2])};
    };
    const Nearest<Doubles> nearest = nearest_on_triangle<Doubles>(at(0), at(3), at(6), at(9));
    alignas(64) double distance[kCount], x[kCount], y[kCount], z[kCount], part[kCount];
    Doubles::store(distance, nearest.distance_squared);
    Doubles::store(x, nearest.point.x);
    Doubles::store(y, nearest.point.y);
    Doubles::store(z, nearest.point.z);
    Doubles::store(part, nearest.part);
    for (int i = 0; i < used_; ++i) {
      if (distance[i] > best_[i]->distance_squared) {
        continue;
      }
      take_if_nearer({distance[i],
                      {x[i], y[i], z[i]},
                      data_.ids[slots_[i]],
                      static_cast<TrianglePart>(static_cast<int>(part[i]))},
                     *best_[i]);
    }
    used_ = 0;
  }

  const BvhData& data_;
  alignas(64) double values_[12][kCount]{};  // point and corners
  std::int32_t slots_[kCount];
  ClosestPoint* best_[kCount];
  int used_{0};
};

/// One point at a time: the boxes of a node side by side.
template <class Lanes, class Doubles>
class PointSearch {
 public:
  PointSearch(const BvhData& data, const Eigen::Vector3d& point)
      : data_(data), point_(point), exact_(data) {
    const Eigen::Vector3d in_frame = data.frame.to_frame(point);
    float reach = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      at_.middle[axis] = static_cast<float>(in_frame[axis]);
      at_.half[axis] = 0.0f;
      reach = std::max(reach, std::abs(at_.middle[axis]));
    }
    error_ = search_error(reach);
  }

  ClosestPoint find(std::int32_t hint) {
    if (hint >= 0) {
      __builtin_prefetch(&data_.corners[hint]);
    }
    Stack stack;
    open(0, stack);
    if (hint >= 0) {
      bound_by(data_.corners[hint]);
    }
    while (!stack.empty()) {
      const Stack::Entry next = stack.pop();
      if (next.bound > limit_) {
        continue;
      }
      const std::int32_t child = data_.nodes[next.parent].child[next.place];
      if (child >= 0) {
        open(child, stack);
      } else {
        try_leaf(~child);
      }
    }
    settle();
    return best_;
  }

 private:
  static constexpr int kCandidates = 64;

  /// Corners are on the surface, so it is no farther than they. That costs next to nothing, and so
  /// a hint that misleads does.
  void bound_by(const Corners& corners) {
    for (const Eigen::Vector3d& corner : corners) {
      const Eigen::Vector3d in_frame = data_.frame.to_frame(corner);
      float sum = 0.0f;
      for (int axis = 0; axis < 3; ++axis) {
        const float away = static_cast<float>(in_frame[axis]) - at_.middle[axis];
        sum += away * away;
      }
      least_ = std::min(least_, sum);
    }
    limit_ = widened(least_, error_);
  }

  void open(std::int32_t at, Stack& stack) {
    const Node& node = data_.nodes[at];
    alignas(64) float distances[kWidth];
    stack.push(at, boxes_within<Lanes, false>(node.turned, at_, limit_, distances), distances);
  }

  void try_leaf(std::int32_t leaf) {
    alignas(64) float distances[kWidth];
    unsigned within = triangles_within<Lanes>(data_.leaves[leaf], at_.middle, limit_, distances);
    for (; within != 0; within &= within - 1) {
      const int i = std::countr_zero(within);
      if (distances[i] > limit_) {
        continue;
      }
      if (used_ == kCandidates) {
        settle();
      }
      slots_[used_] = leaf * kWidth + i;
      distances_[used_++] = distances[i];
      if (distances[i] < least_) {
        least_ = distances[i];
        limit_ = widened(least_, error_);
      }
    }
  }

  void settle() {
    for (int i = 0; i < used_; ++i) {
      if (distances_[i] <= limit_) {
        exact_.add(point_, slots_[i], &best_);
      }
    }
    exact_.finish();
    used_ = 0;
  }

  const BvhData& data_;
  Eigen::Vector3d point_;
  Exact<Doubles> exact_;
  ClosestPoint best_;
  Extent at_;
  float error_, least_{kUnbounded}, limit_{kUnbounded};
  std::int32_t slots_[kCandidates];
  float distances_[kCandidates];
  int used_{0};
};

template <class Lanes, class Doubles>
ClosestPoint search_one(const BvhData& data, const Eigen::Vector3d& point, std::int32_t slot) {
  return PointSearch<Lanes, Doubles>(data, point).find(slot);
}

}  // namespace
}  // namespace haptrial::geometry::kernel
