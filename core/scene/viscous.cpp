#include "core/scene/viscous.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Matrix3d;

double spectral_norm(const Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> squares(matrix.transpose() * matrix,
                                                        Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(squares.eigenvalues().maxCoeff(), 0.0));
}

}  // namespace

/// Directions along which the matrix pushes a motion on are no damper: B is left without them.
StiffnessBound MatrixViscousParameters::bound() const {
  const double rounding = 1e-12 * matrix.cwiseAbs().maxCoeff();
  const bool symmetric = (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= rounding;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> along(0.5 * (matrix + matrix.transpose()));
  const double largest = along.eigenvalues().maxCoeff();
  const bool takes = largest <= rounding;
  const auto cleaned = [&](double value) { return std::abs(value) <= rounding ? 0.0 : value; };
  const Matrix3d driving = along.eigenvectors() * along.eigenvalues().cwiseMax(0.0).asDiagonal() *
                           along.eigenvectors().transpose();
  return {takes && (symmetric || std::isinf(velocity_filter)), 0.0,
          cleaned(spectral_norm(matrix - driving)), cleaned(largest)};
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
