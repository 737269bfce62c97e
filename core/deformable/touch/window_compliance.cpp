#include "core/deformable/touch/window_compliance.h"

#include <Eigen/Cholesky>
#include <set>

#include "core/deformable/springs/spring_hessian.h"
#include "core/deformable/touch/condense.h"
#include "core/deformable/touch/prepared.h"
#include "core/deformable/touch/prepared_bodies.h"

namespace haptrial::deformable {
namespace {

std::vector<std::uint8_t> flags_of(const MovingBody& body) {
  std::vector<std::uint8_t> held(body.springs.rest.size(), 0);
  for (const std::int32_t vertex : body.held) {
    held[static_cast<std::size_t>(vertex)] = 1;
  }
  return held;
}

std::vector<std::int32_t> touched_vertices(const MovingBody& body,
                                           const std::vector<std::uint8_t>& held) {
  std::set<std::int32_t> touched;
  for (const Face& face : body.mesh->felt) {
    for (const std::int32_t vertex : face) {
      if (held[static_cast<std::size_t>(vertex)] == 0) {
        touched.insert(vertex);
      }
    }
  }
  return {touched.begin(), touched.end()};
}

/// @param matrix  symmetric and positive definite; its lower half is read
Eigen::MatrixXf inverse_of(Eigen::MatrixXd matrix) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(matrix);
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows());
  factors.matrixL().solveInPlace(root);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(matrix.rows(), matrix.rows());
  inverse.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose());
  return inverse.selfadjointView<Eigen::Lower>().toDenseMatrix().cast<float>();
}

struct WindowedTissue {
  SharedMovingBody body;
  double window;
  bool operator==(const WindowedTissue&) const = default;
};

}  // namespace

WindowCompliance::WindowCompliance(const MovingBody& body, double time) {
  const std::vector<std::uint8_t> held = flags_of(body);
  const std::vector<std::int32_t> touched = touched_vertices(body, held);
  place_.assign(body.springs.rest.size(), -1);
  for (std::size_t i = 0; i < touched.size(); ++i) {
    place_[static_cast<std::size_t>(touched[i])] = static_cast<std::int32_t>(i);
  }
  SpringHessian hessian(body.springs);
  hessian.assemble(body.springs, body.springs.rest);
  std::vector<double> inertia = body.springs.masses;
  for (double& each : inertia) {
    each /= time * time;
  }
  hessian.matrix().scale_and_add(1.0, inertia);
  inverse_ = inverse_of(condensed(hessian.matrix(), body.springs.rest, held, touched));
}

SharedWindowCompliance prepared_compliance(const SharedMovingBody& body, double window) {
  static PreparedBodies<WindowedTissue, WindowCompliance> bodies;
  return bodies.get({body->mesh, {body, window}}, [&] {
    check_memory(*body->mesh);
    return std::make_shared<const WindowCompliance>(*body, window);
  });
}

}  // namespace haptrial::deformable
