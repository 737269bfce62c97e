#pragma once

// Interface between bvh.cpp and the searches, one file per instruction set.

#include <cmath>
#include <cstddef>

#include "core/base/instruction_set.h"
#include "core/geometry/bvh/bvh_data.h"
#include "core/geometry/mesh/closest_point.h"

namespace haptrial::geometry {

/// A place without a triangle: infinitely far from every point.
void leave_empty(Leaf& leaf, int place);

/// How far the single-precision distances of the search may be from the true ones, in the frame:
/// kErrorUnits u (1 + reach), with u = 2^-24 and `reach` the largest coordinate of the query.
/// docs/algorithms/bounding-volume-hierarchy.md counts the roundings.
inline constexpr float kErrorUnits = 128.0f;
inline float search_error(float reach) { return kErrorUnits * 0x1p-24f * (1.0f + reach); }

namespace kernel {

/// The search in single precision serves points whose frame coordinates are within ±kNear; farther
/// out, what it may be wrong by would let too many triangles through.
inline constexpr double kNear = 16.0;

struct Kernels {
  /// The nearest point of the mesh. `slot` of a triangle that may be near, or -1.
  ClosestPoint (*one)(const BvhData& data, const Eigen::Vector3d& point, std::int32_t slot);
  /// The same for points in an order in which neighbours follow each other, several at a time.
  void (*many)(const BvhData& data, const Eigen::Vector3d* points, std::size_t count,
               ClosestPoint* answers);
  /// Sixteen triangles, given by their corners [m], into a leaf.
  void (*flatten)(const Corners* corners, const Frame& frame, Leaf& leaf);
};

/// The second exists where the compiler targets x86-64.
const Kernels& baseline_kernels();
const Kernels& avx2_kernels();

/// @throws std::invalid_argument when this machine cannot run `set`.
const Kernels& kernels_for(InstructionSet set);

/// The search in double precision, for any finite point.
ClosestPoint closest_in_double(const BvhData& data, const Eigen::Vector3d& point,
                               std::int32_t slot);

/// Whether the search in single precision serves a point, given in the frame; not where a
/// coordinate is no number (a maximum could lose that).
inline bool is_near(const Eigen::Vector3d& in_frame) {
  return std::abs(in_frame.x()) <= kNear && std::abs(in_frame.y()) <= kNear &&
         std::abs(in_frame.z()) <= kNear;
}

/// `here` into `best` where it is nearer, or as near in a triangle of a lower number.
inline void take_if_nearer(const ClosestPoint& here, ClosestPoint& best) {
  if (here.distance_squared < best.distance_squared ||
      (here.distance_squared == best.distance_squared && here.triangle < best.triangle)) {
    best = here;
  }
}

}  // namespace kernel
}  // namespace haptrial::geometry
