#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace haptrial::contact {

/// The square of the sine between two normals below which their line is farther off than the
/// rounding of what defines it: 2^-22 rad.
inline constexpr double kParallel = 0x1p-44;

/// A plane that holds the proxy: it stays where normal · (x - point) >= level.
struct ContactPlane {
  Eigen::Vector3d normal;   // a unit vector, towards the proxy
  Eigen::Vector3d point;    // on the triangle [m]
  double level;             // [m]
  std::int32_t slot;        // of the triangle
  bool curved;              // tangent of a sphere's contact with an edge or a corner
  std::int32_t beside{-1};  // then: the slot of another triangle that is touched there; -1: unknown

  double height(const Eigen::Vector3d& x) const noexcept { return normal.dot(x - point) - level; }
};

/// Place up to which planes let the proxy go.
struct PlaneSolution {
  Eigen::Vector3d move;      // of the proxy [m]
  Eigen::Vector3d residual;  // from the goal to where the move ends: what the planes push with [m]
  std::array<int, 3> active{-1, -1, -1};  // the planes that it ends on
  std::array<double, 3> push{};           // of each: the residual is the sum of push · normal [m]
  int count{0};
  int tried{1};       // points that were computed
  bool solved{true};  // false: no point was found, the move is zero

  /// The sum of the pushes of the planes, each of its own normal force over the stiffness [m].
  double pressure() const noexcept { return push[0] + push[1] + push[2]; }
};

/// Up to a dozen planes through, or beside, the proxy.
class PlaneSet {
 public:
  static constexpr int kMost = 12;

  PlaneSet() = default;
  PlaneSet(const PlaneSet& other) noexcept { *this = other; }
  PlaneSet& operator=(const PlaneSet& other) noexcept {  // a few of a dozen
    count_ = other.count_;
    std::copy_n(other.planes_.begin(), count_, planes_.begin());
    return *this;
  }

  void clear() noexcept { count_ = 0; }
  void keep_first(int count) noexcept { count_ = std::min(count, count_); }
  int size() const noexcept { return count_; }
  const ContactPlane& operator[](int i) const noexcept { return planes_[i]; }
  /// Whether a plane of the same triangle with the same normal is there.
  bool has(const ContactPlane& plane) const noexcept;
  /// False if has() or no room is left.
  bool add(const ContactPlane& plane) noexcept;

  /// The point nearest to the goal on the right side of every plane: of the points nearest to it on
  /// each plane, line and corner of up to three planes, the nearest that no plane refuses.
  /// @param proxy  [m]
  /// @param wish  from the proxy to the goal [m]
  /// @param tolerance  by which a plane may be passed [m]
  PlaneSolution solve(const Eigen::Vector3d& proxy, const Eigen::Vector3d& wish,
                      double tolerance) const noexcept;
  /// The nearest point for a part of the planes, as if the others were not there. `solved` is false
  /// if their normals are too nearly parallel to tell.
  /// @param which  1 to 3 planes
  PlaneSolution solve_on(std::span<const int> which, const Eigen::Vector3d& proxy,
                         const Eigen::Vector3d& wish) const noexcept;

 private:
  std::array<ContactPlane, kMost> planes_;
  int count_{0};
};

}  // namespace haptrial::contact
