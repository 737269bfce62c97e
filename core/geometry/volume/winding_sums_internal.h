#pragma once

#include <cstddef>

#include "core/geometry/volume/boundary_cone.h"

// The kernel of winding_sums(), compiled once for each instruction set: plain loops and plain
// arrays, so that nothing of it is shared between them. CMakeLists.txt lets square roots vectorize.
namespace haptrial::geometry::kernel {
namespace {

/// @param corners  nine floats a triangle
/// @param re, im  receive the product's direction; its angle is half of the solid angle,
/// @param turns  beside whole turns. All three: kPointLanes floats
[[maybe_unused]] inline void sum_windings(const float* corners, std::size_t triangles,
                                          const PointLanes& points, float* re, float* im,
                                          float* turns) {
  const float* x = points.x.data();
  const float* y = points.y.data();
  const float* z = points.z.data();
  for (std::size_t t = 0; t < triangles; ++t, corners += 9) {
    const float* a = corners;
    const float* b = corners + 3;
    const float* c = corners + 6;
#pragma GCC ivdep
    for (int l = 0; l < kPointLanes; ++l) {
      const float ax = a[0] - x[l], ay = a[1] - y[l], az = a[2] - z[l];
      const float bx = b[0] - x[l], by = b[1] - y[l], bz = b[2] - z[l];
      const float cx = c[0] - x[l], cy = c[1] - y[l], cz = c[2] - z[l];
      const float to_a = __builtin_sqrtf(ax * ax + ay * ay + az * az);
      const float to_b = __builtin_sqrtf(bx * bx + by * by + bz * bz);
      const float to_c = __builtin_sqrtf(cx * cx + cy * cy + cz * cz);
      const float across =
          ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
      const float along = to_a * to_b * to_c + (ax * bx + ay * by + az * bz) * to_c +
                          (bx * cx + by * cy + bz * cz) * to_a +
                          (cx * ax + cy * ay + cz * az) * to_b;
      const float next_re = re[l] * along - im[l] * across;
      const float next_im = re[l] * across + im[l] * along;
      const float size = __builtin_fabsf(next_re) + __builtin_fabsf(next_im) + 1e-30f;
      // Past half a turn where two angles of one sign have a sum of the other.
      const float sign = im[l] < 0.0f ? -1.0f : 1.0f;
      const float same = sign * across < 0.0f ? 0.0f : 1.0f;
      const float other = sign * next_im < 0.0f ? 1.0f : 0.0f;
      turns[l] += sign * same * other;
      re[l] = next_re / size;
      im[l] = next_im / size;
    }
  }
}

}  // namespace

void sum_windings_baseline(const float* corners, std::size_t triangles, const PointLanes& points,
                           float* re, float* im, float* turns);
/// Exists where the compiler targets x86-64.
void sum_windings_avx2(const float* corners, std::size_t triangles, const PointLanes& points,
                       float* re, float* im, float* turns);

}  // namespace haptrial::geometry::kernel
