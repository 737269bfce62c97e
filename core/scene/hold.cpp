#include "core/scene/hold.h"

#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d along(const Vector3d& direction, const char* sentence) {
  require(direction.allFinite() && direction.norm() > 0.0, sentence);
  const Vector3d u = direction.normalized();
  return u * u.transpose();
}

Matrix3d held_axes(const AxisChannelParameters& p) {
  return Vector3d(p.free_x ? 0.0 : 1.0, p.free_y ? 0.0 : 1.0, p.free_z ? 0.0 : 1.0).asDiagonal();
}

}  // namespace

Hold::Hold(const Vector3d& place, const Matrix3d& held, const control::PdGains& gains,
           const Setting& setting)
    : place_(place), held_(held), controller_(gains), limit_(setting.limit) {
  require(place.allFinite(), "Spring or channel: its place must be finite");
}

Hold::Hold(const SpringParameters& p, const Setting& setting)
    : Hold(p.to, Matrix3d::Identity(), p.gains, setting) {}

Hold::Hold(const LineChannelParameters& p, const Setting& setting)
    : Hold(p.from,
           Matrix3d::Identity() -
               along(p.to - p.from, "LineChannel: to must be finite and another place than from"),
           p.gains, setting) {}

Hold::Hold(const AxisChannelParameters& p, const Setting& setting)
    : Hold(p.through, held_axes(p), p.gains, setting) {}

Hold::Hold(const PlaneParameters& p, const Setting& setting)
    : Hold(p.through, along(p.normal, "Plane: normal must be finite and not zero"), p.gains,
           setting) {}

Vector3d Hold::force(const Felt& felt, FieldState& state) noexcept {
  const PointState off{held_ * (felt.hand.position - place_), held_ * felt.hand.velocity};
  state.depth = off.position.norm();
  return controller_.force({}, off, felt.shares);
}

double Hold::energy(const Vector3d& p) const noexcept {
  return controller_.stored((held_ * (p - place_)).norm(), limit_);
}

}  // namespace haptrial::scene
