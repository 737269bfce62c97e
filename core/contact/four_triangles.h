#pragma once

// Four triangles side by side, in single precision: which way they lie, about, and how far apart a
// plane across that way keeps them for sure.

#include "core/geometry/mesh/four.h"

namespace haptrial::contact {

using geometry::all_four;
using geometry::Four;
using geometry::FourInts;

/// Four points or directions.
struct Fours {
  Four x, y, z;

  Fours operator+(const Fours& o) const noexcept { return {x + o.x, y + o.y, z + o.z}; }
  Fours operator-(const Fours& o) const noexcept { return {x - o.x, y - o.y, z - o.z}; }
  Fours operator*(Four s) const noexcept { return {x * s, y * s, z * s}; }
  Four dot(const Fours& o) const noexcept { return x * o.x + y * o.y + z * o.z; }
  Fours cross(const Fours& o) const noexcept {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
  /// |x| + |y| + |z|.
  Four size() const noexcept {
    return geometry::larger(x, -x) + geometry::larger(y, -y) + geometry::larger(z, -z);
  }
};

/// `yes` where a condition holds.
inline Fours either(FourInts holds, const Fours& yes, const Fours& no) noexcept {
  return {holds ? yes.x : no.x, holds ? yes.y : no.y, holds ? yes.z : no.z};
}

/// Turned round where that leads against the ways out.
inline Fours outwards(const Fours& v, const Fours& out) noexcept {
  return either(v.dot(out) < 0.0f, v * all_four(-1.0f), v);
}

/// Corners of four triangles.
struct FourTriangles {
  Fours a, b, c;

  Fours middle() const noexcept { return (a + b + c) * all_four(1.0f / 3.0f); }
  /// The most of the corners along an axis.
  Four level(const Fours& axis) const noexcept {
    return geometry::larger(geometry::larger(axis.dot(a), axis.dot(b)), axis.dot(c));
  }
  /// How far they reach from the origin, or more.
  Four far() const noexcept {
    return geometry::larger(geometry::larger(a.size(), b.size()), c.size());
  }
};

/// Vector from the nearest point of an edge to a point, about.
inline Fours from_edge(const Fours& start, const Fours& edge, const Fours& p) noexcept {
  const Fours out = p - start;
  const Four part = edge.dot(out) / edge.dot(edge);
  return out - edge * geometry::smaller(geometry::larger(part, all_four(0.0f)), all_four(1.0f));
}

/// Ways from four triangles to a point, of any length, about; no numbers where there is none.
struct TriangleVectors {
  Fours nearest;  // from the triangle's nearest point
  Fours face;     // along its normal, on the point's side

  TriangleVectors(const FourTriangles& t, const Fours& p) noexcept {
    const Fours ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c, out = p - t.a;
    const Fours normal = ab.cross(bc);
    const Fours off_ab = from_edge(t.a, ab, p), off_bc = from_edge(t.b, bc, p);
    const Fours off_ca = from_edge(t.c, ca, p);
    face = outwards(normal, out);
    nearest = either(off_bc.dot(off_bc) < off_ab.dot(off_ab), off_bc, off_ab);
    nearest = either(off_ca.dot(off_ca) < nearest.dot(nearest), off_ca, nearest);
    const FourInts within = (ab.cross(out).dot(normal) > 0.0f) &
                            (bc.cross(p - t.b).dot(normal) > 0.0f) &
                            (ca.cross(p - t.c).dot(normal) > 0.0f);
    nearest = either(within, face, nearest);
  }
};

/// Zero for what is too short to have a length in single precision.
inline Fours of_length_one(const Fours& v) noexcept {
  constexpr float kLeast = 1e-30f;
  const Four square = v.dot(v);
  return v * (square > kLeast ? all_four(1.0f) / geometry::root(square) : all_four(0.0f));
}

}  // namespace haptrial::contact
