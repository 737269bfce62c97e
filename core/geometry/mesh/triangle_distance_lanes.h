#pragma once

// The nearest point of a triangle, written once for one number and for vectors of them: the same
// operations in the same order, so the same bits. Included by the kernels after their target
// pragma.

namespace haptrial::geometry::kernel {
namespace {

template <class Lanes>
struct Lanes3 {
  typename Lanes::Number x, y, z;
};
template <class Lanes>
[[gnu::always_inline]] inline Lanes3<Lanes> operator-(const Lanes3<Lanes>& a,
                                                      const Lanes3<Lanes>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Number dot(const Lanes3<Lanes>& a,
                                                         const Lanes3<Lanes>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Lanes>
[[gnu::always_inline]] inline Lanes3<Lanes> cross(const Lanes3<Lanes>& a, const Lanes3<Lanes>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The nearest point and what it is nearest to: `part` counts as TrianglePart does.
template <class Lanes>
struct Nearest {
  typename Lanes::Number distance_squared;
  Lanes3<Lanes> point;
  typename Lanes::Number part;
};

/// A point of an edge: how far along it, 0 to 1, and the squared distance to it.
template <class Lanes>
struct AlongEdge {
  typename Lanes::Number t, distance_squared;
};

/// @param from_start, from_end  the query point minus the edge's ends; edge = end - start
template <class Lanes, class Number = typename Lanes::Number>
[[gnu::always_inline]] inline AlongEdge<Lanes> nearest_on_edge(const Lanes3<Lanes>& from_start,
                                                               const Lanes3<Lanes>& from_end,
                                                               const Lanes3<Lanes>& edge) {
  const Number zero = Lanes::all(0.0), one = Lanes::all(1.0);
  const Number length_squared = dot(edge, edge);
  const Number along = dot(from_start, edge) / length_squared;
  const auto usable = Lanes::less(zero, length_squared) & Lanes::less(zero, along);
  const Number t = Lanes::select(usable, Lanes::smaller(along, one), zero);
  const auto at_end = Lanes::less(t, one);  // the end's own difference is exact there
  const Lanes3<Lanes> rest{Lanes::select(at_end, from_start.x - t * edge.x, from_end.x),
                           Lanes::select(at_end, from_start.y - t * edge.y, from_end.y),
                           Lanes::select(at_end, from_start.z - t * edge.z, from_end.z)};
  return {t, dot(rest, rest)};
}

template <class Lanes, class Number = typename Lanes::Number>
[[gnu::always_inline]] inline Nearest<Lanes> nearest_on_triangle(const Lanes3<Lanes>& p,
                                                                 const Lanes3<Lanes>& a,
                                                                 const Lanes3<Lanes>& b,
                                                                 const Lanes3<Lanes>& c) {
  const Number zero = Lanes::all(0.0), one = Lanes::all(1.0);
  const auto ab = b - a, bc = c - b, ca = a - c, ac = c - a;
  const auto ap = p - a, bp = p - b, cp = p - c;
  const AlongEdge<Lanes> on_ab = nearest_on_edge<Lanes>(ap, bp, ab);
  const AlongEdge<Lanes> on_bc = nearest_on_edge<Lanes>(bp, cp, bc);
  const AlongEdge<Lanes> on_ca = nearest_on_edge<Lanes>(cp, ap, ca);
  // Barycentric weights v of b and w of c; the edge that starts at corner e has part 1 + e, the
  // corner itself 4 + e.
  Number best = on_ab.distance_squared, v = on_ab.t, w = zero, along = on_ab.t;
  Number edge = Lanes::all(1.0), next = Lanes::all(2.0);
  const auto take_bc = Lanes::less(on_bc.distance_squared, best);
  best = Lanes::select(take_bc, on_bc.distance_squared, best);
  v = Lanes::select(take_bc, one - on_bc.t, v);
  w = Lanes::select(take_bc, on_bc.t, w);
  along = Lanes::select(take_bc, on_bc.t, along);
  edge = Lanes::select(take_bc, Lanes::all(2.0), edge);
  next = Lanes::select(take_bc, Lanes::all(3.0), next);
  const auto take_ca = Lanes::less(on_ca.distance_squared, best);
  best = Lanes::select(take_ca, on_ca.distance_squared, best);
  v = Lanes::select(take_ca, zero, v);
  w = Lanes::select(take_ca, one - on_ca.t, w);
  along = Lanes::select(take_ca, on_ca.t, along);
  edge = Lanes::select(take_ca, Lanes::all(3.0), edge);
  next = Lanes::select(take_ca, one, next);
  const Number three = Lanes::all(3.0);
  Number part = Lanes::select(Lanes::less(zero, along), edge, edge + three);
  part = Lanes::select(Lanes::less(along, one), part, next + three);

  const auto normal = cross(ab, ac);
  const Number weight_a = dot(normal, cross(bp, cp));
  const Number weight_b = dot(normal, cross(cp, ap));
  const Number weight_c = dot(normal, cross(ap, bp));
  const Number sum = weight_a + weight_b + weight_c;
  const Number face_v = weight_b / sum, face_w = weight_c / sum;
  const Lanes3<Lanes> rest{ap.x - face_v * ab.x - face_w * ac.x,
                           ap.y - face_v * ab.y - face_w * ac.y,
                           ap.z - face_v * ab.z - face_w * ac.z};
  const Number from_face = dot(rest, rest);
  const auto take_face = Lanes::less(zero, weight_a) & Lanes::less(zero, weight_b) &
                         Lanes::less(zero, weight_c) & Lanes::less(from_face, best);
  best = Lanes::select(take_face, from_face, best);
  v = Lanes::select(take_face, face_v, v);
  w = Lanes::select(take_face, face_w, w);
  part = Lanes::select(take_face, zero, part);

  const auto at_b = Lanes::less(Lanes::all(4.5), part) & Lanes::less(part, Lanes::all(5.5));
  const auto at_c = Lanes::less(Lanes::all(5.5), part);
  const auto place = [&](Number a1, Number b1, Number c1, Number ab1, Number ac1) {
    const Number between = a1 + v * ab1 + w * ac1;
    return Lanes::select(at_b, b1, Lanes::select(at_c, c1, between));
  };
  return {best,
          {place(a.x, b.x, c.x, ab.x, ac.x), place(a.y, b.y, c.y, ab.y, ac.y),
           place(a.z, b.z, c.z, ab.z, ac.z)},
          part};
}

/// One number at a time.
struct OneLane {
  using Number = double;
  static double all(double x) { return x; }
  static bool less(double a, double b) { return a < b; }
  static double smaller(double a, double b) { return a < b ? a : b; }
  static double select(bool mask, double yes, double no) { return mask ? yes : no; }
};

}  // namespace
}  // namespace haptrial::geometry::kernel
