#pragma once

// Between equilibrium.cpp and compliance.cpp: Eigen's sparse matrices are slow to compile.

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/law/spring_hessian.h"

namespace haptrial::deformable {

/// The Hessian of a body of springs by the coordinates of the vertices that nothing holds.
class FreeHessian {
 public:
  FreeHessian(const SpringBody& body, std::span<const Hold> holds);

  Eigen::Index size() const { return 3 * Eigen::Index{free_}; }
  bool is_free(std::size_t vertex) const { return number_[vertex] >= 0; }
  Eigen::Index first_of(std::size_t vertex) const { return 3 * Eigen::Index{number_[vertex]}; }

  /// The lower half with vertices at `positions` [N/m].
  Eigen::SparseMatrix<double> lower(const SpringBody& body,
                                    std::span<const Eigen::Vector3d> positions);

 private:
  SpringHessian hessian_;
  std::vector<int> number_;  // of a free vertex; -1: held
  int free_{0};
};

}  // namespace haptrial::deformable
