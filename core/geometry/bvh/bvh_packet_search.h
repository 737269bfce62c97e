#pragma once

// The search for the nearest points of many points at a time, and the table of kernels. Included by
// the kernel files after their target pragma.

#include "core/geometry/bvh/bvh_search.h"
#include "core/geometry/bvh/flatten_lanes.h"

namespace haptrial::geometry::kernel {
namespace {

/// Search for as many points at a time as a vector holds: they share the descent down to the
/// leaves.
template <class Lanes, class Doubles>
class PacketSearch {
  static constexpr int kCount = Lanes::kCount;
  using Number = typename Lanes::Number;

 public:
  explicit PacketSearch(const BvhData& data) : data_(data), exact_(data) {}

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

  /// The triangle that was nearest to the points before is on the surface, so no point is farther
  /// from it.
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
      if (next.bound > limit_) {
        continue;
      }
      const Node& parent = data_.nodes[next.parent];
      const unsigned wanting = active_ & wanted_by(parent.turned, next.place);
      if (wanting == 0) {
        continue;
      }
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

  /// First the distances for all points, which do not wait for each other; then what they mean.
  void try_leaf(std::int32_t leaf, unsigned wanting) {
    alignas(64) float distances[kCount][kWidth];
    unsigned within[kCount];
    for (unsigned rest = wanting; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      const float p[3] = {p_[0][lane], p_[1][lane], p_[2][lane]};
      within[lane] = triangles_within<Lanes>(data_.leaves[leaf], p, limits_[lane], distances[lane]);
    }
    bool nearer = false;
    for (unsigned rest = wanting; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      for (unsigned found = within[lane]; found != 0; found &= found - 1) {
        const int i = std::countr_zero(found);
        const float distance_squared = distances[lane][i];
        if (distance_squared > limits_[lane]) {
          continue;
        }
        if (used_ == kCandidates) {
          make_room();
        }
        candidates_[used_++] = {distance_squared, leaf * kWidth + i, lane};
        if (distance_squared >= least_[lane]) {
          continue;
        }
        least_[lane] = distance_squared;
        limits_[lane] = widened(distance_squared, error_);
        nearer = true;
      }
    }
    if (nearer) {
      limit_ = Lanes::largest(Lanes::load(limits_));
    }
  }

  /// Forgets candidates that have been outdone; measures the rest where they are still many.
  void make_room() {
    int kept = 0;
    for (int i = 0; i < used_; ++i) {
      if (still_near(candidates_[i])) {
        candidates_[kept++] = candidates_[i];
      }
    }
    used_ = kept;
    if (used_ > kCandidates / 2) {
      settle();
    }
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
      for (int axis = 0; axis < 3; ++axis) {
        seen_[axis][i] = static_cast<float>(in_frame[axis]);
      }
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

  const BvhData& data_;
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
void search_many(const BvhData& data, const Eigen::Vector3d* points, std::size_t count,
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
