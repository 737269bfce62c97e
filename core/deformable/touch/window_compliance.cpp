#include "core/deformable/touch/window_compliance.h"

#include <Eigen/Cholesky>
#include <set>
#include <utility>

#include "core/deformable/springs/spring_hessian.h"
#include "core/deformable/touch/condense.h"
#include "core/deformable/touch/prepared.h"
#include "core/deformable/touch/prepared_bodies.h"

namespace haptrial::deformable {
namespace {

std::vector<std::uint8_t> flags_of(const MovingBody& body) {
  std::vector<std::uint8_t> held(body.mesh->tets.vertices.size(), 0);
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

/// K + M / τ² at rest.
BlockMatrix stiffness_over(const MovingBody& body, double time) {
  const std::span<const double> masses =
      body.elements ? body.elements->masses() : std::span<const double>(body.springs.masses);
  std::vector<double> inertia(masses.begin(), masses.end());
  for (double& each : inertia) {
    each /= time * time;
  }
  const auto with_inertia = [&](BlockMatrix stiffness) {
    stiffness.scale_and_add(1.0, inertia);
    return stiffness;
  };
  if (!body.elements) {
    SpringHessian hessian(body.springs);
    hessian.assemble(body.springs, body.springs.rest);
    return with_inertia(std::move(hessian.matrix()));
  }
  BlockMatrix stiffness(body.elements->patches().groups(), masses.size());
  Vectors forces;
  body.elements->stiffness(Vectors(masses.size(), Eigen::Vector3d::Zero()), forces, stiffness);
  return with_inertia(std::move(stiffness));
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
  place_.assign(held.size(), -1);
  for (std::size_t i = 0; i < touched.size(); ++i) {
    place_[static_cast<std::size_t>(touched[i])] = static_cast<std::int32_t>(i);
  }
  inverse_ =
      inverse_of(condensed(stiffness_over(body, time), body.mesh->tets.vertices, held, touched));
}

SharedWindowCompliance prepared_compliance(const SharedMovingBody& body, double window) {
  static PreparedBodies<WindowedTissue, WindowCompliance> bodies;
  return bodies.get({body->mesh, {body, window}}, [&] {
    check_memory(*body->mesh);
    return std::make_shared<const WindowCompliance>(*body, window);
  });
}

}  // namespace haptrial::deformable
