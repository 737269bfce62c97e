#pragma once

#include <memory>

#include "core/deformable/body/linear_system.h"
#include "core/deformable/body/load_case.h"
#include "core/deformable/elements/elastic_body.h"

namespace haptrial::deformable {

struct DynamicOptions {
  double step{1e-3};           // h > 0 [s]
  double mass_damping{};       // alpha >= 0 of C = alpha M + beta K [1/s]
  double stiffness_damping{};  // beta >= 0; K at the beginning of each step [s]
  double tolerance{1e-9};      // norm of the unbalanced forces over that of all forces, > 0
  LinearSolver solver{LinearSolver::kAutomatic};
};

struct Motion {
  Vectors displacement;  // by vertex [m]
  Vectors velocity;      // [m/s]
};

/// A body that moves: masses at the vertices, acceleration a = M^-1 (load + elastic forces - C v).
/// Steps are those of the implicit midpoint: second order; the energy of a linear body is kept to
/// rounding. A step solves for the displacement at its end, by
/// Newton's method with a line search on the potential of the step. With the linear law the matrix
/// is constant and factorized once.
class DynamicSolver {
 public:
  /// @param body  must outlive the solver
  /// @param holds  of vertices, at their displacements from the beginning on
  /// @throws InputError for an option out of its bounds and for holds as check_load().
  DynamicSolver(const ElasticBody& body, const std::vector<Hold>& holds,
                const DynamicOptions& options);
  ~DynamicSolver();
  DynamicSolver(DynamicSolver&&) noexcept;

  const Motion& motion() const;
  /// Places and velocities of the free vertices; held ones stay where they are.
  void set_motion(const Motion& motion);

  /// One step under a constant force on each vertex [N].
  /// @throws InputError naming the time when no balance is found.
  void step(const Vectors& force);

  double time() const;    // [s]
  double energy() const;  // elastic and kinetic [J]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::deformable
