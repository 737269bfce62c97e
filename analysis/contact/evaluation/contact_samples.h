#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace haptrial::evaluation {

/// Forces and motion of a probe on a body, sample by sample, in the body's frame.
struct ContactSamples {
  std::vector<double> time;               // (n) increasing [s]
  std::vector<Eigen::Vector3d> position;  // (n) of the contact on the surface [m]
  std::vector<Eigen::Vector3d> velocity;  // (n) of that place; its part along the surface counts
  std::vector<Eigen::Vector3d> normal;    // (n) unit length, out of the body
  std::vector<Eigen::Vector3d> force;     // (n) on the probe [N]
  std::vector<double> depth;              // (n) of the probe below the mesh [m]

  std::size_t size() const { return time.size(); }
};

/// @throws std::invalid_argument for lengths that differ, times that do not increase, a value that
/// is not finite or a normal without unit length.
void check(const ContactSamples& samples);

struct PathVelocity {
  std::vector<Eigen::Vector3d> velocity;  // (n) [m/s]
  double noise{0.0};  // standard error of a component, from what the lines leave [m/s]
};

/// Velocities of a noisy path: the slopes of straight lines fitted to the samples within `width`
/// seconds around each, at least three.
/// @param time      (n >= 3) increasing [s]
/// @param position  (n) [m]
/// @throws std::invalid_argument for fewer samples, lengths that differ or a width not above 0.
PathVelocity path_velocity(std::span<const double> time, std::span<const Eigen::Vector3d> position,
                           double width);

}  // namespace haptrial::evaluation
