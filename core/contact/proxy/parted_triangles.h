#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/surface/contact_surface.h"

namespace haptrial::contact {

/// Triangles around a place, each behind a plane of its own:
///
///     axis · x <= level   for every point x of the triangle, |axis| = 1
///
/// What stays in front of a plane, farther than its radius, does not meet the triangle, wherever
/// it has been before. Most are passed over in single precision, four at a time, with a margin for
/// all of its rounding.
class PartedTriangles {
 public:
  explicit PartedTriangles(std::size_t most);

  /// An empty list for triangles of which a part, at least, is nearer to `middle` than `reach`.
  void clear(const Eigen::Vector3d& middle, double reach) noexcept;
  /// The plane is across the line from the triangle's middle to `from`.
  void add(std::int32_t slot, const geometry::Corners& corners,
           const Eigen::Vector3d& from) noexcept;
  /// Another plane: it touches the triangle from the side of `axis`, a unit vector.
  void part(int i, const geometry::Corners& corners, const Eigen::Vector3d& axis) noexcept;

  int size() const noexcept { return count_; }
  std::int32_t slot(int i) const noexcept { return slots_[static_cast<std::size_t>(i)]; }

  struct Candidate {
    int i;
    double t;  // not met before this part of the move
  };
  /// Those that no plane keeps apart, in the list's order.
  /// @param from, move  within the reach around the middle [m]
  /// @param off  how far what moves has to keep off: its radius and what rounding asks for [m]
  /// @param found  as long as the list
  /// @returns how many there are
  int within(const Eigen::Vector3d& from, const Eigen::Vector3d& move, double off,
             std::span<Candidate> found) const noexcept;

 private:
  struct Plane {
    Eigen::Vector3d axis;
    double level;  // of the plane above the list's middle [m]
    double far;    // how far the triangle reaches from there [m]
  };

  Eigen::Vector3d middle_{Eigen::Vector3d::Zero()};  // [m]
  double scale_{1.0};                                // of lengths to units of the list's reach
  std::vector<std::int32_t> slots_;
  std::vector<Plane> planes_;
  std::vector<float> x_, y_, z_, level_;  // the same, up to a multiple of four
  int count_{0};
};

}  // namespace haptrial::contact
