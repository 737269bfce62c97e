#pragma once

#include <memory>
#include <span>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

/// One V-cycle of geometric multigrid as a preconditioner, for vertices on a cubic lattice, as
/// those of a body of voxels are: lattices of twice the spacing each, their matrices P^T A P, one
/// sweep of Gauss-Seidel by blocks forwards and one backwards on each, and a dense solve on the
/// last.
class Multigrid {
 public:
  /// @param held  by vertex: no value there; must outlive this
  Multigrid(std::span<const Eigen::Vector3d> vertices, const BlockMatrix& pattern,
            std::span<const std::uint8_t> held);
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;

  /// Whether the vertices lie on a lattice. If not, nothing else may be called.
  bool fits() const;

  /// Takes the values of `a`, which must stay as they are. @returns false if `a` is seen not to be
  /// positive definite.
  bool set(const BlockMatrix& a);

  /// z is near A^-1 r, and 0 on held vertices; symmetric and positive definite as a map.
  void apply(const Vectors& r, Vectors& z);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::deformable
