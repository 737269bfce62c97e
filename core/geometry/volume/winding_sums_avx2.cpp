// The kernel of this file is compiled for AVX2; it runs where the processor has it.
#ifdef __x86_64__

// These headers come before the instructions are switched on, so that nothing shared is compiled
// with them.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/volume/boundary_cone.h"

#pragma GCC push_options
#pragma GCC target("avx2")

#include "core/geometry/volume/winding_sums_internal.h"

namespace haptrial::geometry::kernel {

void sum_windings_avx2(const float* corners, std::size_t triangles, const PointLanes& points,
                       float* re, float* im, float* turns) {
  sum_windings(corners, triangles, points, re, im, turns);
}

}  // namespace haptrial::geometry::kernel

#pragma GCC pop_options

#endif
