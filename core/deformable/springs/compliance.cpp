#include "core/deformable/springs/compliance.h"

#include "core/deformable/body/cholesky.h"
#include "core/deformable/springs/spring_hessian.h"
#include "core/deformable/springs/spring_tangent.h"

namespace haptrial::deformable {

std::optional<std::vector<Eigen::Vector3d>> small_displacements(
    const SpringBody& body, std::span<const Hold> holds, std::span<const Eigen::Vector3d> positions,
    std::span<const Eigen::Vector3d> forces) {
  SpringHessian hessian(body);
  hessian.assemble(body, positions);
  Cholesky factors(hessian.matrix(), held_flags(body.rest.size(), holds));
  if (!factors.factorize(hessian.matrix())) {
    return std::nullopt;
  }
  Vectors result;
  factors.solve(Vectors(forces.begin(), forces.end()), result);
  return result;
}

}  // namespace haptrial::deformable
