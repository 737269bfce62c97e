#pragma once

#include <Eigen/Core>

namespace haptrial::geometry {

/// Exact signs of determinants of doubles: a bound on the rounding error decides most, sums of
/// products without rounding the rest. Coordinates from 1e-90 to 1e90 in size, or 0.
/// Source: Shewchuk 1997, Adaptive precision floating-point arithmetic.

/// The sign of (b - a) x (p - a): 1 where a, b, p run anticlockwise, -1 clockwise, 0 in line.
int side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p);

/// The sign of n·(p - a) with n = (b - a) x (c - a): 1 where p is on the side from which a, b, c
/// run anticlockwise, 0 in their plane.
int side_of_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& p);

}  // namespace haptrial::geometry
