#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"
#include "core/base/random.h"
#include "core/subject/perceiver/contact_episodes.h"
#include "core/subject/perceiver/felt.h"

namespace haptrial::subject {

/// Feels a quantity through the hand, an interval at a time: what the hand meets
/// (contact_episodes.h), and how that is felt (felt.h).
///
///     Sense sense(senses, Quantity::kStiffness);
///     sense.begin(random);                // the interval begins: its noise is drawn
///     sense.feel(force, hand, dt);        // every tick of it
///     double percept = sense.percept();   // after it, or during it
///
/// Servo thread: no allocation, lock, I/O or throw (SenseTest.DoesNotAllocate).
class Sense {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  Sense(const SenseParameters& senses, Quantity quantity);

  void begin(RandomStream& random) noexcept;
  /// @param force  that the device applies to the hand, in W [N]; @param dt  > 0 [s]
  void feel(const Eigen::Vector3d& force, const PointState& hand, double dt) noexcept {
    episodes_.feel(force, hand, dt);
  }
  /// Percept so far [unit of the quantity]. A force near nothing can be felt below 0; free air has
  /// stiffness 0 and infinite compliance.
  double percept() const noexcept;
  ContactEpisode met() const noexcept { return episodes_.met(quantity_); }  // without noise
  Quantity quantity() const noexcept { return quantity_; }

 private:
  SenseParameters senses_;
  Quantity quantity_;
  ContactEpisodes episodes_;
  FeltNoise noise_;
};

}  // namespace haptrial::subject
