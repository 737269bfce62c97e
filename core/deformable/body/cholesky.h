#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

/// CHOLMOD's supernodal Cholesky factors of a BlockMatrix without the held vertices' rows and
/// columns. The order of elimination is found once for a pattern.
class Cholesky {
 public:
  /// @param held  by vertex
  Cholesky(const BlockMatrix& pattern, std::span<const std::uint8_t> held);
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;

  /// @param a  of the same pattern
  /// @returns false if `a` is not positive definite.
  bool factorize(const BlockMatrix& a);

  /// Factors of `a`, or where it is not positive definite of `a` with a growing diagonal until it
  /// is. @returns what was added to the diagonal, 0 for nothing; nothing at all where even
  /// 10^6 times the mean diagonal does not help, as where `a` is not finite.
  std::optional<double> factorize_raised(BlockMatrix& a);

  /// x = A^-1 b, and 0 on the held vertices. After a factorize() that succeeded.
  void solve(const Vectors& b, Vectors& x);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::deformable
