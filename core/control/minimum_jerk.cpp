#include "core/control/minimum_jerk.h"

namespace haptrial::control {

MinimumJerkMove::MinimumJerkMove(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                 double peak_speed) noexcept
    : from_(from), to_(to), duration_(1.875 * (to - from).norm() / peak_speed) {}

PointState MinimumJerkMove::at(double time) const noexcept {
  if (time >= duration_) {
    return {to_, Eigen::Vector3d::Zero()};
  }
  const double u = time > 0.0 ? time / duration_ : 0.0;
  const double u2 = u * u;
  const Eigen::Vector3d way = to_ - from_;
  return {from_ + way * (u * u2 * (10.0 - 15.0 * u + 6.0 * u2)),
          way * (30.0 * u2 * (1.0 - 2.0 * u + u2) / duration_)};
}

}  // namespace haptrial::control
