#pragma once

#include "core/geometry/bvh_data.h"

namespace haptrial::geometry {

/// A triangle in its own flat coordinates, computed in double precision from the corners as given.
FlatTriangle flatten(const Corners& corners, const Frame& frame);

/// How far the single-precision distances of the search may be from the true ones, in the frame:
/// kErrorUnits u (1 + reach), with u = 2^-24 and `reach` the largest coordinate of the query.
/// docs/algorithms/bounding-volume-hierarchy.md counts the roundings.
inline constexpr float kErrorUnits = 128.0f;
inline float search_error(float reach) { return kErrorUnits * 0x1p-24f * (1.0f + reach); }

/// The squared distance from a point of the frame to a triangle in single precision; Number is a
/// float or a vector of them, Lanes what the kernels define.
///
/// On each side of the altitude the triangle is a right triangle, the intersection of a quadrant
/// and of a strip below the hypotenuse; the larger of the distances to these two is that to it.
template <class Lanes, class Number = typename Lanes::Number>
[[gnu::always_inline]] inline Number flat_distance_squared(const FlatTriangle& t, Number px,
                                                           Number py, Number pz) {
  const auto row = [&](const float* r) {
    return Lanes::fma(
        Lanes::all(r[0]), px,
        Lanes::fma(Lanes::all(r[1]), py, Lanes::fma(Lanes::all(r[2]), pz, Lanes::all(r[3]))));
  };
  const Number zero = Lanes::all(0.0f);
  const Number x = row(t.row[0]), y = row(t.row[1]), z = row(t.row[2]);
  const auto left = Lanes::less(x, zero);
  const auto of_half = [&](float a, float b) {
    return Lanes::select(left, Lanes::all(a), Lanes::all(b));
  };
  const Number leg = of_half(t.half[0].leg, t.half[1].leg);
  const Number dx = of_half(t.half[0].dx, t.half[1].dx);
  const Number dy = of_half(t.half[0].dy, t.half[1].dy);
  const Number length = of_half(t.half[0].length, t.half[1].length);
  const Number from_tip = leg - Lanes::absolute(x);
  const Number along = Lanes::fma(dx, from_tip, dy * y);
  const Number beside = Lanes::larger(Lanes::fma(dx, y, zero - dy * from_tip), zero);
  const Number past = along - Lanes::smaller(Lanes::larger(along, zero), length);
  const Number strip = Lanes::fma(past, past, beside * beside);
  const Number off_tip = Lanes::smaller(from_tip, zero), below = Lanes::smaller(y, zero);
  const Number quadrant = Lanes::fma(off_tip, off_tip, below * below);
  return Lanes::fma(z, z, Lanes::larger(strip, quadrant));
}

}  // namespace haptrial::geometry
