#pragma once

#include <memory>
#include <span>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

enum class LinearSolver {
  kAutomatic,           // whichever was measured to be faster
  kConjugateGradients,  // little memory; slow for nu near 0.5
  kCholesky,            // its time does not depend on nu
};

/// The faster solver of a system, as measured (docs/algorithms/deformable-elements.md).
/// @param vertices  that are free  @param poisson  the largest ratio of the materials
LinearSolver faster_solver(std::size_t vertices, double poisson);

/// A x = b with some vertices held, for one pattern and any number of values.
class LinearSystem {
 public:
  /// @param vertices  at rest: a body on a lattice gets a better preconditioner (multigrid.h)
  /// @param held  by vertex; must outlive the system
  /// @param solver  not kAutomatic
  LinearSystem(std::span<const Eigen::Vector3d> vertices, const BlockMatrix& pattern,
               std::span<const std::uint8_t> held, LinearSolver solver);
  ~LinearSystem();
  LinearSystem(LinearSystem&&) noexcept;

  /// Takes the values of `a`, which must stay as they are until the last solve(). Where `a` is not
  /// positive definite Cholesky gets a growing diagonal until it is.
  void set(BlockMatrix& a);

  /// @param residual  the norm of b - A x that is small enough [N]; Cholesky's is at rounding
  /// @returns iterations. x is a direction of descent for b also where `a` is not positive
  /// definite.
  int solve(const Vectors& b, double residual, Vectors& x);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::deformable
