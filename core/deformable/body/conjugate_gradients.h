#pragma once

#include <functional>
#include <span>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

struct GradientOptions {
  double residual{};  // stops at this norm of it, >= 0 [N]
  int most{100000};   // iterations
};

struct GradientResult {
  int iterations{};
  double residual{};          // its norm at the end [N]
  bool negative_curvature{};  // the matrix is not positive definite: stopped there
};

/// Sets z near A^-1 r, by a symmetric and positive definite map that is 0 on held vertices.
using Preconditioner = std::function<void(const Vectors& r, Vectors& z)>;

/// The inverse of the diagonal blocks.
Preconditioner block_jacobi(const BlockMatrix& a, std::span<const std::uint8_t> held);

/// Conjugate gradients on A x = b.
/// @param held  by vertex: x stays 0 there, and the rows and columns of A are left out
/// @param x  receives the solution; where curvature is negative, the best so far, which is a
///     direction of descent for b
GradientResult conjugate_gradients(const BlockMatrix& a, const Vectors& b,
                                   std::span<const std::uint8_t> held,
                                   const Preconditioner& precondition,
                                   const GradientOptions& options, Vectors& x);

}  // namespace haptrial::deformable
