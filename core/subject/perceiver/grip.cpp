#include "core/subject/perceiver/grip.h"

namespace haptrial::subject {

void Grip::feel(const Tip& a, const Tip& b, double dt) noexcept {
  const double force_a = a.force.norm();
  const double force_b = b.force.norm();
  const double way = (a.state.position - b.state.position).norm();
  const bool touch = force_a > contact_force_ && force_b > contact_force_;
  if (!touch || !(way < 1e9)) {
    return;
  }
  touching_ += dt;
  way_ += way * dt;
  push_ += 0.5 * (force_a + force_b) * dt;
  if (a.state.velocity.norm() < moving_speed_ && b.state.velocity.norm() < moving_speed_) {
    resting_ += dt;
    resting_way_ += way * dt;
  }
}

ContactEpisode Grip::met() const noexcept {
  if (!held()) {
    return {};
  }
  return {resting_ > 0.0 ? resting_way_ / resting_ : way_ / touching_, push_ / touching_};
}

}  // namespace haptrial::subject
