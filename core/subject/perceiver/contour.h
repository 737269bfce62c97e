#pragma once

#include <Eigen/Core>
#include <array>

#include "core/base/point_state.h"

namespace haptrial::subject {

/// Contour following, the exploration by which people find a shape (Lederman and Klatzky 1987): to
/// the object, then round it about one axis, then about another one, pressed on lightly. Where the
/// second axis comes out of the surface, the hand goes round across both instead.
struct Contour {
  Eigen::Vector3d towards{0.0, -1.0, 0.0};  // the object, in W, any length above 0
  /// The axes of the loops in W, any length above 0: the hand goes anticlockwise about them.
  std::array<Eigen::Vector3d, 2> around{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()};
  double turn_after{4.0};  // with the second axis from then on > 0 [s]
  double speed{0.05};      // along the surface > 0 [m/s]
  double force{1.0};       // on it > 0 [N]
};

/// Next target of a hand that follows a contour. The surface's normal is taken from the force that
/// is felt; while nothing is felt, behind an edge, it is turned on in the direction of the loop
/// until something is. Servo thread: no allocation, lock, I/O or throw.
class ContourFollower {
 public:
  void begin(const Contour& contour, const Eigen::Vector3d& at) noexcept;

  /// Target of the arm on a tick.
  struct Step {
    Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // [m/s]
    Eigen::Vector3d push{Eigen::Vector3d::Zero()};      // [N]
    Eigen::Vector3d off_loop{Eigen::Vector3d::Zero()};  // back to the loop's plane [m]
  };
  /// @param time  since it began [s]  @param felt  force on the hand in W [N]  @param dt  > 0 [s]
  Step step(double time, const PointState& hand, const Eigen::Vector3d& felt, double dt) noexcept;

 private:
  void turn_to(std::size_t axis, const Eigen::Vector3d& at) noexcept;

  Contour contour_;
  Eigen::Vector3d axis_{Eigen::Vector3d::UnitZ()};
  Eigen::Vector3d outward_{Eigen::Vector3d::UnitY()};  // the normal as it is taken to be
  Eigen::Vector3d plane_{Eigen::Vector3d::Zero()};     // a place in the loop's plane [m]
  Eigen::Vector3d start_{Eigen::Vector3d::Zero()};     // [m]
  Eigen::Vector3d last_{Eigen::Vector3d::Zero()};      // contact [m]
  double without_{0.0};                                // since then [s]
  std::size_t turned_{0};
  bool touched_{false};
};

}  // namespace haptrial::subject
