#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

/// Masses at the vertices of any body, from rest on under a constant load:
///
///     m a = load + elastic(u) - c v
struct MotionProblem {
  std::vector<double> masses;      // (vertices) [kg]
  std::vector<double> drag;        // c by vertex, >= 0 [N·s/m]
  std::vector<std::uint8_t> held;  // by vertex: 1 stays at `start`
  Vectors start;                   // displacements at the beginning, without velocity [m]
  Vectors load;                    // on each vertex [N]
  /// Sets the elastic forces at a displacement [N]. @returns false where none are defined, as in a
  /// tetrahedron that is inside out; the solver takes a smaller step then.
  std::function<bool(const Vectors&, Vectors&)> elastic;
};

struct MotionAccuracy {
  double relative{1e-8};  // tolerance of a step, > 0
  double length{1e-3};    // displacements are told apart to relative · length, > 0 [m]
};

/// Displacements at the given times by SUNDIALS CVODE: Adams' method of variable order and step,
/// whose local error stays within the tolerance. One step costs a few evaluations of the forces.
/// @param times  ascending, above 0 [s]
/// @param reached  callback after each of them; may throw to end the integration
/// @throws InputError naming the time that was not reached.
std::vector<Vectors> reference_motion(const MotionProblem& problem, std::span<const double> times,
                                      const MotionAccuracy& accuracy = {},
                                      const std::function<void(double)>& reached = {});

/// Root mean square over all vertices and times of the distance between two motions [m].
double motion_distance(std::span<const Vectors> a, std::span<const Vectors> b);

/// Damping by mass [1/s] with which `motion_at` comes nearest to a reference, between `low` and
/// `high` > low > 0, to 1 in 10⁴ of the range's logarithm (Brent's method).
double fitted_damping(std::span<const Vectors> reference, double low, double high,
                      const std::function<std::vector<Vectors>(double damping)>& motion_at);

}  // namespace haptrial::deformable
