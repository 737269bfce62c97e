#include "core/deformable/springs/stable_step.h"

#include <limits>

#include "core/deformable/body/fastest_vibration.h"
#include "core/deformable/springs/spring_hessian.h"

namespace haptrial::deformable {

double fastest_vibration(const SpringBody& body, std::span<const Eigen::Vector3d> positions,
                         std::span<const std::int32_t> held) {
  SpringHessian hessian(body);
  hessian.assemble(body, positions);
  return fastest_vibration(hessian.matrix(), body.masses, held);
}

double stable_step(const SpringBody& body, std::span<const std::int32_t> held) {
  const double fastest = fastest_vibration(body, body.rest, held);
  return fastest > 0 ? 2 / fastest : std::numeric_limits<double>::infinity();
}

}  // namespace haptrial::deformable
