#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"
#include "core/subject/perceiver/felt.h"

namespace haptrial::subject {

/// The way between two fingertips that hold something, over an interval: the mean distance of the
/// two while both touch and rest, or while both touch if they never rest. Touching and resting as
/// in contact_episodes.h. Servo thread: no allocation, lock, I/O or throw.
class Grip {
 public:
  /// A fingertip at a tick.
  struct Tip {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on it, in W [N]
    PointState state;                                // in W
  };
  explicit Grip(const SenseParameters& senses) noexcept
      : contact_force_(senses.contact_force), moving_speed_(senses.moving_speed) {}

  void begin() noexcept { *this = Grip(contact_force_, moving_speed_); }
  /// @param dt  > 0 [s]
  void feel(const Tip& a, const Tip& b, double dt) noexcept;

  bool held() const noexcept { return touching_ > 0.0; }  // both touched at once
  /// The way and the mean force of the two; 0 if nothing was held.
  ContactEpisode met() const noexcept;

 private:
  Grip(double contact_force, double moving_speed) noexcept
      : contact_force_(contact_force), moving_speed_(moving_speed) {}

  double contact_force_;
  double moving_speed_;
  double touching_{0.0}, resting_{0.0};  // [s]
  double way_{0.0}, resting_way_{0.0};   // distance times time [m s]
  double push_{0.0};                     // force times time [N s]
};

}  // namespace haptrial::subject
