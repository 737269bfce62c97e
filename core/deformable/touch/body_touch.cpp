#include "core/deformable/touch/body_touch.h"

#include <cmath>

#include "core/base/require.h"

namespace haptrial::deformable {

void check(const TouchOptions& options) {
  require(std::isfinite(options.radius) && options.radius >= 0.0,
          "radius must be finite and at least 0");
  require(std::isfinite(options.stiffness) && options.stiffness > 0.0,
          "stiffness must be finite and above 0");
  const contact::Friction& friction = options.friction;
  require(std::isfinite(friction.static_friction) && friction.dynamic_friction >= 0.0 &&
              friction.static_friction >= friction.dynamic_friction,
          "friction: static must be at least dynamic, and dynamic at least 0");
}

void bound_change(const Eigen::Vector3d& before, double bent, double by_itself,
                  contact::Contact& contact) noexcept {
  const Eigen::Vector3d change = contact.force - before;
  const double most = bent + by_itself;
  if (const double size = change.norm(); size > most) {
    contact.force = before + most / size * change;
    const bool lost = contact.state == contact::ContactState::kFree;
    contact.state = lost ? contact::ContactState::kStick : contact.state;
  }
}

}  // namespace haptrial::deformable
