// The kernel of this file is compiled for AVX-512; it runs where the processor has it.
#ifdef __x86_64__

// Before the instructions are switched on, so that nothing shared is compiled with them.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/winding/boundary_cone.h"

#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx2,prefer-vector-width=512")

#include "core/geometry/winding/winding_sums_internal.h"

namespace haptrial::geometry::kernel {

void sum_windings_avx512(const float* corners, std::size_t triangles, const PointLanes& points,
                         float* re, float* im, float* turns) {
  sum_windings(corners, triangles, points, re, im, turns);
}

}  // namespace haptrial::geometry::kernel

#pragma GCC pop_options

#endif
