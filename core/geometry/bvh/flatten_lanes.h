#pragma once

// Triangles into the flat coordinates of a leaf, several at a time. Included by the kernels after
// their target pragma.

#include "core/geometry/bvh/flat_triangle.h"
#include "core/geometry/mesh/triangle_distance_lanes.h"

namespace haptrial::geometry::kernel {
namespace {

template <class Lanes>
[[gnu::always_inline]] inline Lanes3<Lanes> scaled(const Lanes3<Lanes>& a,
                                                   typename Lanes::Number by) {
  return {a.x * by, a.y * by, a.z * by};
}
template <class Lanes, class Mask>
[[gnu::always_inline]] inline Lanes3<Lanes> select(const Mask& mask, const Lanes3<Lanes>& yes,
                                                   const Lanes3<Lanes>& no) {
  return {Lanes::select(mask, yes.x, no.x), Lanes::select(mask, yes.y, no.y),
          Lanes::select(mask, yes.z, no.z)};
}

/// Unit vectors at right angles to unit vectors: across the axis that these are least along.
template <class Lanes>
[[gnu::always_inline]] inline Lanes3<Lanes> across(const Lanes3<Lanes>& u) {
  const auto zero = Lanes::all(0.0), one = Lanes::all(1.0);
  const auto x = u.x * u.x, y = u.y * u.y, z = u.z * u.z;
  const auto by_x = Lanes::less(x, y) & Lanes::less(x, z);
  const auto axis_x = Lanes::select(by_x, one, zero);
  const auto axis_y = Lanes::select(Lanes::less(y, z), one - axis_x, zero);
  const Lanes3<Lanes> v = cross(u, {axis_x, axis_y, one - axis_x - axis_y});
  return scaled(v, one / Lanes::root(dot(v, v)));
}

template <class Lanes>
[[gnu::always_inline]] inline void write_half(typename Lanes::Number leg,
                                              typename Lanes::Number height, int side, int first,
                                              Leaf& leaf) {
  const auto zero = Lanes::all(0.0), one = Lanes::all(1.0);
  const auto length = Lanes::root(leg * leg + height * height);
  const auto has_length = Lanes::less(zero, length);
  Lanes::store_floats(leaf.leg[side] + first, leg);
  Lanes::store_floats(leaf.dx[side] + first, Lanes::select(has_length, leg / length, one));
  Lanes::store_floats(leaf.dy[side] + first, Lanes::select(has_length, height / length, zero));
  Lanes::store_floats(leaf.length[side] + first, length);
}

/// @param a, b, c  corners as given, b - a the longest edge
template <class Lanes>
[[gnu::always_inline]] inline void write_flat(const Lanes3<Lanes>& a, const Lanes3<Lanes>& b,
                                              const Lanes3<Lanes>& c, const Frame& frame, int first,
                                              Leaf& leaf) {
  using Number = typename Lanes::Number;
  const Number zero = Lanes::all(0.0), one = Lanes::all(1.0), scale = Lanes::all(frame.scale);
  // Differences of the corners as given lose nothing.
  const auto ab = scaled(b - a, scale), ac = scaled(c - a, scale);
  const Number base = Lanes::root(dot(ab, ab));
  const Lanes3<Lanes> unit_x{one, zero, zero};
  const auto u = select(Lanes::less(zero, base), scaled(ab, one / base), unit_x);
  const auto normal = cross(ab, ac);
  const Number twice_area = Lanes::root(dot(normal, normal));
  // Below this the normal is rounding, and the height less than the search resolves.
  const auto has_area = Lanes::less(Lanes::all(1e-8) * base * base, twice_area);
  const auto n = select(has_area, scaled(normal, one / twice_area), across(u));
  const Number height = Lanes::select(has_area, twice_area / base, zero);
  const Number along = dot(u, ac);
  const Number foot = Lanes::smaller(Lanes::select(Lanes::less(zero, along), along, zero), base);
  const Lanes3<Lanes> centre{Lanes::all(frame.centre.x()), Lanes::all(frame.centre.y()),
                             Lanes::all(frame.centre.z())};
  const auto start = scaled(a - centre, scale);
  const Lanes3<Lanes> origin{start.x + foot * u.x, start.y + foot * u.y, start.z + foot * u.z};
  const Lanes3<Lanes> axes[3] = {u, cross(n, u), n};
  for (int i = 0; i < 3; ++i) {
    Lanes::store_floats(leaf.row[i][0] + first, axes[i].x);
    Lanes::store_floats(leaf.row[i][1] + first, axes[i].y);
    Lanes::store_floats(leaf.row[i][2] + first, axes[i].z);
    Lanes::store_floats(leaf.row[i][3] + first, zero - dot(axes[i], origin));
  }
  write_half<Lanes>(foot, height, 0, first, leaf);
  write_half<Lanes>(base - foot, height, 1, first, leaf);
}

/// @param corners  sixteen triangles [m]
template <class Lanes>
void flatten(const Corners* corners, const Frame& frame, Leaf& leaf) {
  for (int first = 0; first < kWidth; first += Lanes::kCount) {
    alignas(64) double values[9][Lanes::kCount];
    for (int i = 0; i < Lanes::kCount; ++i) {
      for (int k = 0; k < 9; ++k) {
        values[k][i] = corners[first + i][k / 3][k % 3];
      }
    }
    const auto corner = [&](int k) {
      return Lanes3<Lanes>{Lanes::load(values[3 * k]), Lanes::load(values[3 * k + 1]),
                           Lanes::load(values[3 * k + 2])};
    };
    const auto a = corner(0), b = corner(1), c = corner(2);
    const auto ab = b - a, bc = c - b, ca = a - c;
    const auto from_a = dot(ab, ab), from_b = dot(bc, bc), from_c = dot(ca, ca);
    const auto by_b = Lanes::less(from_a, from_b);
    const auto by_c = Lanes::less(Lanes::select(by_b, from_b, from_a), from_c);
    write_flat<Lanes>(select(by_c, c, select(by_b, b, a)), select(by_c, a, select(by_b, c, b)),
                      select(by_c, b, select(by_b, a, c)), frame, first, leaf);
  }
}

}  // namespace
}  // namespace haptrial::geometry::kernel
