#pragma once

// Included by the kernels after their target pragma, so nothing here may have external linkage for
// all of them: only a template over their own types.

#include "core/geometry/bvh/bvh_kernel.h"

namespace haptrial::geometry {

/// Squared distances between points of the frame and triangles in single precision. Lanes is what
/// the kernels define; fetch(values) takes what is needed of the sixteen values of a leaf: one
/// triangle for many points, or many triangles for one.
///
/// On each side of the altitude the triangle is a right triangle, the intersection of a quadrant
/// and of a strip below the hypotenuse; the larger of the distances to these two is that to it.
template <class Lanes, class Fetch, class Number = typename Lanes::Number>
[[gnu::always_inline]] inline Number flat_distance_squared(const Leaf& leaf, Fetch fetch, Number px,
                                                           Number py, Number pz) {
  const auto row = [&](const float(&r)[4][kWidth]) {
    return Lanes::fma(fetch(r[0]), px,
                      Lanes::fma(fetch(r[1]), py, Lanes::fma(fetch(r[2]), pz, fetch(r[3]))));
  };
  const Number zero = Lanes::all(0.0f);
  const Number x = row(leaf.row[0]), y = row(leaf.row[1]), z = row(leaf.row[2]);
  const auto left = Lanes::less(x, zero);
  const auto of_half = [&](const float(&values)[2][kWidth]) {
    return Lanes::select(left, fetch(values[0]), fetch(values[1]));
  };
  const Number leg = of_half(leaf.leg), dx = of_half(leaf.dx), dy = of_half(leaf.dy);
  const Number length = of_half(leaf.length);
  const Number from_tip = leg - Lanes::absolute(x);
  const Number along = Lanes::fma(dx, from_tip, dy * y);
  const Number beside = Lanes::larger(dx * y - dy * from_tip, zero);
  const Number past = along - Lanes::smaller(Lanes::larger(along, zero), length);
  const Number strip = Lanes::fma(past, past, beside * beside);
  const Number off_tip = Lanes::smaller(from_tip, zero), below = Lanes::smaller(y, zero);
  const Number quadrant = Lanes::fma(off_tip, off_tip, below * below);
  return Lanes::fma(z, z, Lanes::larger(strip, quadrant));
}

}  // namespace haptrial::geometry
