#pragma once

#include <memory>

#include "core/deformable/body/linear_system.h"
#include "core/deformable/body/load_case.h"
#include "core/deformable/elements/elastic_body.h"

namespace haptrial::deformable {

struct StaticOptions {
  double tolerance{1e-8};  // norm of the unbalanced forces over that of loads and reactions, > 0
  LinearSolver solver{LinearSolver::kAutomatic};
  int most_newton_steps{40};  // for one load step
  int most_halvings{10};      // of the load step: the smallest is 2^-10 of the load
};

/// A body at rest under a load.
struct StaticResult {
  Vectors displacement;   // by vertex [m]
  Vectors elastic_force;  // by vertex [N]: minus the load, and minus what a hold reacts with
  double energy{};        // elastic [J]
  double residual{};      // as StaticOptions::tolerance
  int load_steps{};
  int newton_steps{};
  int linear_iterations{};  // of all linear systems; Cholesky counts 1 for each
};

/// The memory that solve_static() takes beside the mesh: at most for conjugate gradients, as
/// measured on regular blocks for Cholesky, whose factors grow faster than the mesh [bytes].
double static_memory(std::size_t vertices, std::size_t tetrahedra, LinearSolver solver);

/// Statics of one body: the pattern of its stiffness is found once for all loads.
class StaticSolver {
 public:
  /// @param body  must outlive the solver
  explicit StaticSolver(const ElasticBody& body, const StaticOptions& options = {});
  ~StaticSolver();
  StaticSolver(StaticSolver&&) noexcept;

  /// Newton's method with a line search on the potential energy. The whole load first; where that
  /// fails, half of what is left, and so on.
  /// Source: Morris 2006, §5.3.2 ("this quasi-static analysis neglects dynamic effects").
  /// @throws InputError as check_load(), and naming the load, how far it got and a tetrahedron when
  /// it tears or inverts the mesh.
  StaticResult solve(const LoadCase& load);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for one load.
StaticResult solve_static(const ElasticBody& body, const LoadCase& load,
                          const StaticOptions& options = {});

}  // namespace haptrial::deformable
