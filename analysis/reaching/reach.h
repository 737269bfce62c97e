#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

namespace haptrial::analysis {

/// One reach as it was recorded; the spans are equally long and stay the caller's.
struct Reach {
  std::span<const double> time;               // (n) rising [s]
  std::span<const Eigen::Vector3d> position;  // (n) [m]
  std::span<const Eigen::Vector3d> velocity;  // (n) [m/s]
  std::span<const Eigen::Vector3d> force;     // (n) of the device on the hand [N]; may be empty
  Eigen::Vector3d start{0.0, 0.0, 0.0};       // [m]
  Eigen::Vector3d target{0.0, 0.0, 0.0};      // [m]
  double go{0.0};                             // the instant of the go signal, as `time` [s]
};

/// Two directions in the plane of a movement, seen from the tip of its normal: `along` from start
/// to target, `left` a quarter turn counterclockwise from it. With the normal +y, up, and a reach
/// away from the participant (-z), left is the participant's left (-x). Everything lateral is
/// positive on the left: a force or a displacement that is positive turns the way counterclockwise.
class WayFrame {
 public:
  /// @throws std::invalid_argument when the normal is 0 or start and target lie on a line along it.
  WayFrame(const Eigen::Vector3d& start, const Eigen::Vector3d& target,
           const Eigen::Vector3d& normal = Eigen::Vector3d::UnitY());

  const Eigen::Vector3d& along() const { return along_; }  // unit vectors
  const Eigen::Vector3d& left() const { return left_; }
  double distance() const { return distance_; }  // from start to target, in the plane [m]

  double along(const Eigen::Vector3d& vector) const { return along_.dot(vector); }
  /// 0 for what is only rounding of the vector's longer parts.
  double lateral(const Eigen::Vector3d& vector) const;
  /// Angle from the way to a vector, counterclockwise, in (-π, π] [rad].
  double angle(const Eigen::Vector3d& vector) const;

 private:
  Eigen::Vector3d along_;
  Eigen::Vector3d left_;
  double distance_;
};

/// @throws std::invalid_argument naming the span whose length differs, or `time` when it does not
/// rise or has fewer than two samples.
void check_reach(const Reach& reach);

/// Linear between samples; nothing outside of the recording.
std::optional<Eigen::Vector3d> value_at(std::span<const double> time,
                                        std::span<const Eigen::Vector3d> values, double instant);

}  // namespace haptrial::analysis
