#include "core/deformable/springs/compliance.h"

#include <Eigen/CholmodSupport>

#include "core/deformable/springs/free_hessian.h"

namespace haptrial::deformable {

std::optional<std::vector<Eigen::Vector3d>> small_displacements(
    const SpringBody& body, std::span<const Hold> holds, std::span<const Eigen::Vector3d> positions,
    std::span<const Eigen::Vector3d> forces) {
  FreeHessian hessian(body, holds);
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> factors;
  factors.cholmod().print = 0;  // what is not positive definite is no fault here
  factors.compute(hessian.lower(body, positions));
  if (factors.info() != Eigen::Success) {
    return std::nullopt;
  }
  Eigen::VectorXd f(hessian.size());
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (hessian.is_free(v)) {
      f.segment<3>(hessian.first_of(v)) = forces[v];
    }
  }
  const Eigen::VectorXd u = factors.solve(f);
  std::vector<Eigen::Vector3d> result(forces.size(), Eigen::Vector3d::Zero());
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (hessian.is_free(v)) {
      result[v] = u.segment<3>(hessian.first_of(v));
    }
  }
  return result;
}

}  // namespace haptrial::deformable
