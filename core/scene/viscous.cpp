#include "core/scene/viscous.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/scene/require.h"

namespace haptrial::scene {
namespace {

/// @param matrix  symmetric
double largest_eigenvalue(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

}  // namespace

StiffnessBound MatrixViscousParameters::bound() const {
  const double size = matrix.cwiseAbs().maxCoeff();
  const double largest = largest_eigenvalue(matrix + matrix.transpose());
  const bool symmetric = (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * size;
  const bool takes = largest <= 1e-12 * size;
  return {takes && (symmetric || std::isinf(velocity_filter)), 0.0,
          std::sqrt(largest_eigenvalue(matrix.transpose() * matrix))};
}

Viscous::Viscous(const ViscousParameters& p, const Setting& setting)
    : matrix_(-p.damping * Eigen::Matrix3d::Identity()), filter_(p.velocity_filter, setting.rate) {
  require(std::isfinite(p.damping) && p.damping >= 0.0,
          "Viscous: damping must be finite and at least 0");
  require(is_positive(p.velocity_filter), "Viscous: velocity_filter must be above 0");
}

Viscous::Viscous(const MatrixViscousParameters& p, const Setting& setting)
    : matrix_(p.matrix), filter_(p.velocity_filter, setting.rate) {
  require(p.matrix.allFinite(), "MatrixViscous: matrix must be finite");
  require(is_positive(p.velocity_filter), "MatrixViscous: velocity_filter must be above 0");
}

Eigen::Vector3d Viscous::force(const Felt& felt, FieldState& state) noexcept {
  state.velocity = filter_.next(felt.hand.velocity);
  return felt.shares.damping * (matrix_ * state.velocity);
}

}  // namespace haptrial::scene
