#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/bvh/bvh_data.h"
#include "core/geometry/mesh/ray_crossing.h"

namespace haptrial::geometry {
namespace {

/// Boxes are widened by this much in the frame: more than their rounding and that of the crossings.
constexpr double kBoxError = 1e-6;

/// A ray in the frame, for boxes.
struct Slabs {
  Eigen::Vector3d origin, inverse;
  double widen;

  Slabs(const Ray& ray, const Frame& frame) : origin(frame.to_frame(ray.origin)) {
    const Eigen::Vector3d direction = ray.direction * frame.scale;
    for (int axis = 0; axis < 3; ++axis) {
      // A ray along a slab stays in it or outside, at any t that it may have.
      const double least = 1e-200;
      inverse[axis] = 1.0 / (std::abs(direction[axis]) > least ? direction[axis] : least);
    }
    widen = kBoxError + 1e-12 * origin.norm();
  }

  /// The part of the ray that crosses a child's box, in t; empty where first > last.
  std::pair<double, double> cross(const Boxes& boxes, int child, double begin, double end) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (boxes.low[axis][child] - widen - origin[axis]) * inverse[axis];
      const double b = (boxes.high[axis][child] + widen - origin[axis]) * inverse[axis];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    return {begin, end};
  }
};

/// Calls visit(hit) for every crossing; it returns where the ray now ends.
template <class Visit>
void traverse(const BvhData& data, const Ray& ray, Visit visit) {
  if (data.nodes.empty() || !ray.origin.allFinite() || !ray.direction.allFinite() ||
      ray.direction.isZero(0.0)) {
    return;
  }
  const RayCrossing crossing(ray);
  const Slabs slabs(ray, data.frame);
  // A crossing's t is rounded apart from its box's.
  const double early = ray.begin - 1e-9 * std::abs(ray.begin);
  double end = ray.end;
  std::array<std::int32_t, kMaxDepth * kWidth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t at = stack[--top];
    const Boxes& boxes = at < 0 ? data.leaf_boxes[~at] : data.nodes[at].boxes;
    for (int i = 0; i < kWidth && !std::isinf(boxes.low[0][i]); ++i) {
      const auto [first, last] = slabs.cross(boxes, i, early, end + 1e-9 * std::abs(end));
      if (first > last) {
        continue;
      }
      if (at >= 0) {
        stack[top++] = data.nodes[at].child[i];
        continue;
      }
      const std::int32_t slot = ~at * kWidth + i;
      const auto here = crossing(data.corners[slot]);
      if (here && here->t >= ray.begin && here->t <= end) {
        end = visit(RayHit{here->t, data.ids[slot], here->entering});
      }
    }
  }
}

}  // namespace

std::optional<RayHit> Bvh::nearest_hit(const Ray& ray) const {
  std::optional<RayHit> nearest;
  traverse(*data_, ray, [&](const RayHit& hit) {
    if (!nearest || hit.t < nearest->t || hit.triangle < nearest->triangle) {
      nearest = hit;
    }
    return nearest->t;
  });
  return nearest;
}

void Bvh::all_hits(const Ray& ray, std::vector<RayHit>& hits) const {
  hits.clear();
  traverse(*data_, ray, [&](const RayHit& hit) {
    hits.push_back(hit);
    return ray.end;
  });
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
    return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
  });
}

bool Bvh::contains(const Eigen::Vector3d& point) const {
  bool inside = false;
  traverse(*data_, {point, Eigen::Vector3d::UnitX()}, [&](const RayHit&) {
    inside = !inside;
    return std::numeric_limits<double>::infinity();
  });
  return inside;
}

}  // namespace haptrial::geometry
