#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>

namespace haptrial::test {

template <std::size_t n>
using PointsOf = std::array<Eigen::Vector3d, n>;

/// Sum of forces on n points, relative to the forces themselves.
struct Leak {
  double force;   // |sum| over the sum of sizes
  double torque;  // about the origin, over the sum of sizes and the points' extent
};

template <std::size_t n>
Leak leak_of(const PointsOf<n>& points, const PointsOf<n>& forces) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  double size = 0;
  double extent = 0;
  for (std::size_t i = 0; i < n; ++i) {
    force += forces[i];
    torque += points[i].cross(forces[i]);
    size += forces[i].norm();
    extent = std::max(extent, points[i].norm());
  }
  return {force.norm() / size, torque.norm() / (size * extent)};
}

/// The law of every elastic element: forces are minus the gradient of the energy, by central
/// differences, and neither push nor turn the whole, to rounding.
/// @param energy, forces  functions of n points [m]
/// @param step  of the differences [m]
template <std::size_t n, class Energy, class Forces>
void expect_force_law(const Energy& energy, const Forces& forces, const PointsOf<n>& points,
                      double step) {
  const PointsOf<n> given = forces(points);
  double largest = 0;
  for (const Eigen::Vector3d& force : given) {
    largest = std::max(largest, force.norm());
  }
  ASSERT_GT(largest, 0) << "a law of no force says nothing";
  for (std::size_t i = 0; i < n; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      PointsOf<n> above = points;
      PointsOf<n> below = points;
      above[i][axis] += step;
      below[i][axis] -= step;
      const double slope = (energy(above) - energy(below)) / (2 * step);
      EXPECT_NEAR(given[i][axis], -slope, 1e-6 * largest) << "point " << i << ", axis " << axis;
    }
  }
  const Leak leak = leak_of<n>(points, given);
  EXPECT_LT(leak.force, 1e-14);
  EXPECT_LT(leak.torque, 1e-14);
}

}  // namespace haptrial::test
