#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/contact/four_triangles.h"

namespace haptrial::contact {

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
    Fours p, v;                 // the same, in units of the list's reach
    Four apart;                 // what has to be between a plane and the move

    /// Point of each triangle that is nearest to a place.
    Fours beside(const Fours& place) const noexcept;
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
