#include "core/scene/viscous.h"

#include <cmath>

#include "core/scene/require.h"

namespace haptrial::scene {

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
