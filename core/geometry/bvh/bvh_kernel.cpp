#include "core/geometry/bvh/bvh_kernel.h"

#include <algorithm>
#include <array>

#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::geometry {
namespace {

/// Single-precision boxes and what they are compared with may be wrong by this much in the frame.
constexpr double kKernelBoxError = 1e-6;

struct Pending {
  std::int32_t node;  // or ~leaf
  double bound;       // no triangle below is nearer, in the frame
};

/// The distance of a point to a child's box, in the frame.
double box_distance(const Boxes& boxes, int child, const Eigen::Vector3d& p) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double outside = std::max(
        {double{boxes.low[axis][child]} - p[axis], p[axis] - double{boxes.high[axis][child]}, 0.0});
    sum += outside * outside;
  }
  return std::sqrt(sum);
}

}  // namespace

namespace kernel {

const Kernels& kernels_for(InstructionSet set) {
  return choose(set, baseline_kernels, HAPTRIAL_X86(avx2_kernels))();
}

ClosestPoint closest_in_double(const BvhData& data, const Eigen::Vector3d& point,
                               std::int32_t slot) {
  ClosestPoint best;
  const auto measure = [&](std::int32_t at) {
    const Corners& corners = data.corners[at];
    ClosestPoint here = closest_on_triangle(point, corners[0], corners[1], corners[2]);
    here.triangle = data.ids[at];
    take_if_nearer(here, best);
  };
  if (slot >= 0) {
    measure(slot);
  }
  const Eigen::Vector3d p = data.frame.to_frame(point);
  const double slack = kKernelBoxError + 1e-12 * p.norm();
  const auto reach = [&] {
    return std::sqrt(best.distance_squared) * data.frame.scale * (1.0 + 1e-12) + slack;
  };
  std::array<Pending, kMaxDepth * kWidth> stack;
  int top = 0;
  stack[top++] = {0, 0.0};
  while (top > 0) {
    const Pending next = stack[--top];
    if (next.bound > reach()) {
      continue;
    }
    const bool leaf = next.node < 0;
    const Boxes& boxes = leaf ? data.leaf_boxes[~next.node] : data.nodes[next.node].boxes;
    const int first = top;
    for (int i = 0; i < kWidth && !std::isinf(boxes.low[0][i]); ++i) {
      const double bound = box_distance(boxes, i, p);
      if (!(bound <= reach())) {
        continue;
      }
      if (leaf) {
        measure(~next.node * kWidth + i);
      } else {
        stack[top++] = {data.nodes[next.node].child[i], bound};
      }
    }
    std::sort(stack.begin() + first, stack.begin() + top,
              [](const Pending& a, const Pending& b) { return a.bound > b.bound; });
  }
  return best;
}

}  // namespace kernel

}  // namespace haptrial::geometry
