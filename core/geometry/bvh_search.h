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

#include "core/geometry/bvh_kernel.h"
#include "core/geometry/flat_triangle.h"
#include "core/geometry/flatten_lanes.h"
#include "core/geometry/triangle_distance_lanes.h"

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
        if (kSpread) half = Lanes::fma(Lanes::absolute(row), Lanes::all(from.half[k]), half);
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
    if (within == 0) return;
    int nearest = size;
    for (; within != 0; within &= within - 1) {
      const int i = std::countr_zero(within);
      entries[size] = {distances[i], node, i};
      if (distances[i] < entries[nearest].bound) nearest = size;
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
  explicit Exact(const Bvh::Data& data) : data_(data) {}

  /// The answer goes into *best when it is the nearer one, at the latest in finish().
  [[gnu::always_inline]] void add(const Eigen::Vector3d& point, std::int32_t slot,
                                  ClosestPoint* best) {
    const Corners& corners = data_.corners[slot];
    for (int axis = 0; axis < 3; ++axis) {
      values_[axis][used_] = point[axis];
      for (int k = 0; k < 3; ++k) values_[3 + 3 * k + axis][used_] = corners[k][axis];
    }
    slots_[used_] = slot;
    best_[used_] = best;
    if (++used_ == kCount) measure();
  }
  void finish() {
    if (used_ > 0) measure();
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
      if (distance[i] > best_[i]->distance_squared) continue;
      take_if_nearer({distance[i],
                      {x[i], y[i], z[i]},
                      data_.ids[slots_[i]],
                      static_cast<TrianglePart>(static_cast<int>(part[i]))},
                     *best_[i]);
    }
    used_ = 0;
  }

  const Bvh::Data& data_;
  alignas(64) double values_[12][kCount]{};  // point and corners
  std::int32_t slots_[kCount];
  ClosestPoint* best_[kCount];
  int used_{0};
};

/// One point at a time: the boxes of a node side by side.
template <class Lanes, class Doubles>
class PointSearch {
 public:
  PointSearch(const Bvh::Data& data, const Eigen::Vector3d& point)
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
    if (hint >= 0) try_leaf(hint / kWidth);
    Stack stack;
    open(0, stack);
    while (!stack.empty()) {
      const Stack::Entry next = stack.pop();
      if (next.bound > limit_) continue;
      const std::int32_t child = data_.nodes[next.parent].child[next.place];
      if (child >= 0) {
        open(child, stack);
      } else if (~child != hint / kWidth || hint < 0) {
        try_leaf(~child);
      }
    }
    settle();
    return best_;
  }

 private:
  static constexpr int kCandidates = 64;

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
      if (distances[i] > limit_) continue;
      if (used_ == kCandidates) settle();
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
      if (distances_[i] <= limit_) exact_.add(point_, slots_[i], &best_);
    }
    exact_.finish();
    used_ = 0;
  }

  const Bvh::Data& data_;
  Eigen::Vector3d point_;
  Exact<Doubles> exact_;
  ClosestPoint best_;
  Extent at_;
  float error_, least_{kUnbounded}, limit_{kUnbounded};
  std::int32_t slots_[kCandidates];
  float distances_[kCandidates];
  int used_{0};
};

/// As many points at a time as a vector holds: they share the descent down to the leaves.
template <class Lanes, class Doubles>
class PacketSearch {
  static constexpr int kCount = Lanes::kCount;
  using Number = typename Lanes::Number;

 public:
  explicit PacketSearch(const Bvh::Data& data) : data_(data), exact_(data) {}

  /// @param points, answers  `count` from 1 to kCount, each near (is_near)
  void find(const Eigen::Vector3d* const* points, ClosestPoint* const* answers, int count) {
    points_ = points;
    answers_ = answers;
    place(count);
    bound_by_neighbours();
    descend();
    settle();
    remember(count);
  }

 private:
  static constexpr int kCandidates = 256;

  /// The points into the frame. Lanes to spare repeat the last point, and want nothing.
  void place(int count) {
    active_ = (1u << count) - 1u;
    float reach = 0.0f;
    for (int i = 0; i < kCount; ++i) {
      const Eigen::Vector3d in_frame = data_.frame.to_frame(*points_[std::min(i, count - 1)]);
      for (int axis = 0; axis < 3; ++axis) {
        p_[axis][i] = static_cast<float>(in_frame[axis]);
        reach = std::max(reach, std::abs(p_[axis][i]));
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      const Number p = Lanes::load(p_[axis]);
      const float low = Lanes::smallest(p), high = Lanes::largest(p);
      extent_.middle[axis] = 0.5f * (low + high);
      extent_.half[axis] = 0.5f * (high - low);
    }
    error_ = search_error(reach);
  }

  /// What was nearest to the points before is on the surface, so no point is farther from it.
  void bound_by_neighbours() {
    Number least = Lanes::all(kUnbounded);
    const Number px = Lanes::load(p_[0]), py = Lanes::load(p_[1]), pz = Lanes::load(p_[2]);
    for (int i = 0; i < remembered_; ++i) {
      const Number x = px - Lanes::all(seen_[0][i]), y = py - Lanes::all(seen_[1][i]),
                   z = pz - Lanes::all(seen_[2][i]);
      least = Lanes::smaller(least, Lanes::fma(x, x, Lanes::fma(y, y, z * z)));
    }
    Lanes::store(least_, least);
    const Number limit = Lanes::root(least) + Lanes::all(2.0f * error_);
    Lanes::store(limits_, Lanes::smaller(limit * limit, Lanes::all(kUnbounded)));
    limit_ = Lanes::largest(Lanes::load(limits_));
  }

  void descend() {
    stack_.size = 0;
    open(0);
    while (!stack_.empty()) {
      const Stack::Entry next = stack_.pop();
      if (next.bound > limit_) continue;
      const Node& parent = data_.nodes[next.parent];
      const unsigned wanting = active_ & wanted_by(parent.turned, next.place);
      if (wanting == 0) continue;
      const std::int32_t child = parent.child[next.place];
      if (child >= 0) {
        open(child);
      } else {
        try_leaf(~child, wanting);
      }
    }
  }

  /// The points that a child's box is near enough to.
  unsigned wanted_by(const TurnedBoxes& boxes, int child) const {
    const Number zero = Lanes::all(0.0f);
    Number sum = zero;
    for (int axis = 0; axis < 3; ++axis) {
      Number at = Lanes::all(boxes.row[axis][3][child]);
      for (int k = 0; k < 3; ++k) {
        at = Lanes::fma(Lanes::all(boxes.row[axis][k][child]), Lanes::load(p_[k]), at);
      }
      const Number outside =
          Lanes::larger(Lanes::absolute(at) - Lanes::all(boxes.half[axis][child]), zero);
      sum = Lanes::fma(outside, outside, sum);
    }
    return Lanes::bits(Lanes::less_equal(sum, Lanes::load(limits_)));
  }

  void open(std::int32_t at) {
    alignas(64) float distances[kWidth];
    const unsigned within =
        boxes_within<Lanes, true>(data_.nodes[at].turned, extent_, limit_, distances);
    stack_.push(at, within, distances);
  }

  void try_leaf(std::int32_t leaf, unsigned wanting) {
    alignas(64) float distances[kWidth];
    bool nearer = false;
    for (; wanting != 0; wanting &= wanting - 1) {
      const int lane = std::countr_zero(wanting);
      const float p[3] = {p_[0][lane], p_[1][lane], p_[2][lane]};
      unsigned within = triangles_within<Lanes>(data_.leaves[leaf], p, limits_[lane], distances);
      for (; within != 0; within &= within - 1) {
        const int i = std::countr_zero(within);
        if (distances[i] > limits_[lane]) continue;
        if (used_ == kCandidates) make_room();
        candidates_[used_++] = {distances[i], leaf * kWidth + i, lane};
        if (distances[i] < least_[lane]) {
          least_[lane] = distances[i];
          limits_[lane] = widened(distances[i], error_);
          nearer = true;
        }
      }
    }
    if (nearer) limit_ = Lanes::largest(Lanes::load(limits_));
  }

  /// Forgets candidates that have been outdone; measures the rest where they are still many.
  void make_room() {
    int kept = 0;
    for (int i = 0; i < used_; ++i) {
      if (still_near(candidates_[i])) candidates_[kept++] = candidates_[i];
    }
    used_ = kept;
    if (used_ > kCandidates / 2) settle();
  }

  void settle() {
    for (int i = 0; i < used_; ++i) {
      const Candidate& candidate = candidates_[i];
      if (still_near(candidate)) {
        exact_.add(*points_[candidate.lane], candidate.slot, answers_[candidate.lane]);
      }
    }
    exact_.finish();
    used_ = 0;
  }

  void remember(int count) {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d in_frame = data_.frame.to_frame(answers_[i]->point);
      for (int axis = 0; axis < 3; ++axis) seen_[axis][i] = static_cast<float>(in_frame[axis]);
    }
    remembered_ = count;
  }

  /// A triangle that may be the nearest to a point.
  struct Candidate {
    float distance_squared;
    std::int32_t slot;
    int lane;
  };
  bool still_near(const Candidate& candidate) const {
    return candidate.distance_squared <= limits_[candidate.lane];
  }

  const Bvh::Data& data_;
  Exact<Doubles> exact_;
  const Eigen::Vector3d* const* points_{nullptr};
  ClosestPoint* const* answers_{nullptr};
  unsigned active_{0};
  alignas(64) float p_[3][kCount];
  alignas(64) float seen_[3][kCount];
  alignas(64) float least_[kCount];   // squared distance to the nearest seen so far
  alignas(64) float limits_[kCount];  // and how far the nearest can still be
  float limit_{kUnbounded};           // the largest of these
  int remembered_{0};
  Extent extent_;
  float error_{0.0f};
  Stack stack_;
  Candidate candidates_[kCandidates];
  int used_{0};
};

template <class Lanes, class Doubles>
ClosestPoint search_one(const Bvh::Data& data, const Eigen::Vector3d& point, std::int32_t slot) {
  return PointSearch<Lanes, Doubles>(data, point).find(slot);
}

template <class Lanes, class Doubles>
void search_many(const Bvh::Data& data, const Eigen::Vector3d* points, std::size_t count,
                 ClosestPoint* answers) {
  PacketSearch<Lanes, Doubles> search(data);
  const Eigen::Vector3d* packet[Lanes::kCount];
  ClosestPoint* places[Lanes::kCount];
  int filled = 0;
  for (std::size_t i = 0; i < count; ++i) {
    answers[i] = {};
    const Eigen::Vector3d in_frame = data.frame.to_frame(points[i]);
    if (is_near(in_frame)) {
      packet[filled] = points + i;
      places[filled++] = answers + i;
    } else if (points[i].allFinite()) {
      answers[i] = closest_in_double(data, points[i], -1);
    }
    if (filled == Lanes::kCount || (i + 1 == count && filled > 0)) {
      search.find(packet, places, filled);
      filled = 0;
    }
  }
}

template <class Lanes, class Doubles>
Kernels kernels_of() {
  return {search_one<Lanes, Doubles>, search_many<Lanes, Doubles>, flatten<Doubles>};
}

}  // namespace
}  // namespace haptrial::geometry::kernel
