#pragma once

#include <Eigen/Core>

namespace haptrial::deformable {

/// Places where a tool may press on a body, at most kMost: how the gaps between them follow from
/// the forces,
///
///     gap = free_gap + compliance force,   force >= 0,  gap >= 0,  force · gap = 0
struct PressedPlaces {
  static constexpr int kMost = 64;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;

  Matrix compliance;  // symmetric, positive definite [m/N]
  Vector free_gap;    // without forces [m]
};

/// Solves it by principal pivots: of all places whose force or gap is negative while their number
/// falls, else of the last one alone, which ends for every such matrix (Murty).
/// After: Júdice and Pires 1994, A block principal pivoting algorithm.
/// @param force  where it is above 0 a place is taken to be pressed at first; receives the forces
/// @returns false if it did not end in time; then `force` holds what is not negative.
/// Servo thread: no allocation, lock or throw.
bool press(const PressedPlaces& places, PressedPlaces::Vector& force) noexcept;

}  // namespace haptrial::deformable
