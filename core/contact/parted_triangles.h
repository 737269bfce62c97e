#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/geometry/mesh/four.h"

// Four triangles side by side, in single precision: which way they lie, about, and how far apart a
// plane across that way keeps them for sure.

namespace haptrial::contact {

using geometry::all_four;
using geometry::Four;
using geometry::FourInts;

/// Four points or directions.
struct FourVectors {
  Four x, y, z;

  FourVectors operator+(const FourVectors& o) const noexcept { return {x + o.x, y + o.y, z + o.z}; }
  FourVectors operator-(const FourVectors& o) const noexcept { return {x - o.x, y - o.y, z - o.z}; }
  FourVectors operator*(Four s) const noexcept { return {x * s, y * s, z * s}; }
  Four dot(const FourVectors& o) const noexcept { return x * o.x + y * o.y + z * o.z; }
  FourVectors cross(const FourVectors& o) const noexcept {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
  /// |x| + |y| + |z|.
  Four size() const noexcept {
    return geometry::larger(x, -x) + geometry::larger(y, -y) + geometry::larger(z, -z);
  }
};

/// `yes` where a condition holds.
inline FourVectors either(FourInts holds, const FourVectors& yes, const FourVectors& no) noexcept {
  return {holds ? yes.x : no.x, holds ? yes.y : no.y, holds ? yes.z : no.z};
}

/// Turned round where that leads against the ways out.
inline FourVectors outwards(const FourVectors& v, const FourVectors& out) noexcept {
  return either(v.dot(out) < 0.0f, v * all_four(-1.0f), v);
}

/// Corners of four triangles.
struct FourTriangles {
  FourVectors a, b, c;

  FourVectors middle() const noexcept { return (a + b + c) * all_four(1.0f / 3.0f); }
  /// The most of the corners along an axis.
  Four level(const FourVectors& axis) const noexcept {
    return geometry::larger(geometry::larger(axis.dot(a), axis.dot(b)), axis.dot(c));
  }
  /// How far they reach from the origin, or more.
  Four far() const noexcept {
    return geometry::larger(geometry::larger(a.size(), b.size()), c.size());
  }
};

/// Vector from the nearest point of an edge to a point, about.
inline FourVectors from_edge(const FourVectors& start, const FourVectors& edge,
                             const FourVectors& p) noexcept {
  const FourVectors out = p - start;
  const Four part = edge.dot(out) / edge.dot(edge);
  return out - edge * geometry::smaller(geometry::larger(part, all_four(0.0f)), all_four(1.0f));
}

/// Ways from four triangles to a point, of any length, about; no numbers where there is none.
struct TriangleVectors {
  FourVectors nearest;  // from the triangle's nearest point
  FourVectors face;     // along its normal, on the point's side

  TriangleVectors(const FourTriangles& t, const FourVectors& p) noexcept {
    const FourVectors ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c, out = p - t.a;
    const FourVectors normal = ab.cross(bc);
    const FourVectors off_ab = from_edge(t.a, ab, p), off_bc = from_edge(t.b, bc, p);
    const FourVectors off_ca = from_edge(t.c, ca, p);
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
inline FourVectors of_length_one(const FourVectors& v) noexcept {
  constexpr float kLeast = 1e-30f;
  const Four square = v.dot(v);
  return v * (square > kLeast ? all_four(1.0f) / geometry::root(square) : all_four(0.0f));
}

/// Triangles around a place, each behind a plane of its own:
///
///     axis · x <= level   for every point x of the triangle, |axis| = 1
///
/// What stays in front of a plane, farther than its radius, does not meet the triangle, wherever
/// it has been before. Most are passed over in single precision, four at a time, with a margin for
/// all of its rounding; a plane that no longer keeps its triangle apart is looked for anew, the
/// same way.
class PartedTriangles {
 public:
  explicit PartedTriangles(std::size_t most);

  /// An empty list for triangles of which a part, at least, is nearer to `middle` than `reach`.
  void clear(const Eigen::Vector3d& middle, double reach) noexcept;
  void add(std::int32_t slot, const geometry::Corners& corners) noexcept;
  /// Ends the list: every plane is across the line from its triangle's middle to `from`.
  void part_all(const Eigen::Vector3d& from) noexcept;
  /// Another plane: it touches the triangle from the side of `axis`, a unit vector.
  void part(int i, const geometry::Corners& corners, const Eigen::Vector3d& axis) noexcept;

  int size() const noexcept { return count_; }
  std::int32_t slot(int i) const noexcept { return slots_[static_cast<std::size_t>(i)]; }

  struct Candidate {
    int i;
    double t;      // not met before this part of the move
    bool touched;  // at its beginning, or nearly so
  };
  /// A move, as the list sees it.
  struct Move {
    Eigen::Vector3d from, way;  // from the list's middle [m]
    double off;                 // [m]
    FourVectors p, v;           // the same, in units of the list's reach
    Four apart;                 // what has to be between a plane and the move

    /// Point of each triangle that is nearest to a place.
    FourVectors beside(const FourVectors& place) const noexcept;
  };
  /// @param from, move  within the reach around the middle [m]
  /// @param off  how far what moves has to keep off: its radius and what rounding asks for [m]
  Move in_list(const Eigen::Vector3d& from, const Eigen::Vector3d& move, double off) const noexcept;
  /// Candidates that no plane keeps apart, in the list's order.
  /// @param found  as long as the list
  /// @returns how many there are
  int within(const Move& move, std::span<Candidate> found) const noexcept;
  /// Looks for other planes for a few of them, and keeps those that none keeps apart.
  /// @param found  at most kTogether
  /// @returns how many are left, at the beginning of `found`, in their order
  int part_anew(const Move& move, std::span<Candidate> found) noexcept;
  static constexpr int kTogether = 4;

 private:
  /// A plane in double precision, for triangles that touch the surface.
  struct Plane {
    Eigen::Vector3d axis;
    double level;  // of the plane above the list's middle [m]
    bool known;    // else only the plane in single precision holds
  };
  /// About the list's middle, in units of its reach.
  struct alignas(16) Flat {
    float x[4], y[4], z[4];  // of three corners
  };
  struct FourPlanes;
  static FourPlanes best_planes(const FourTriangles& triangles, const Move& move,
                                unsigned wanted) noexcept;
  FourTriangles four(const std::array<int, 4>& which) const noexcept;

  Eigen::Vector3d middle_{Eigen::Vector3d::Zero()};  // [m]
  double scale_{1.0};                                // of lengths to units of the list's reach
  std::vector<std::int32_t> slots_;
  std::vector<Plane> planes_;
  std::vector<Flat> flat_;
  std::vector<float> x_, y_, z_, level_;  // planes, up to a multiple of four
  int count_{0};
};

}  // namespace haptrial::contact
