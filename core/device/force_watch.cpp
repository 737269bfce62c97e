#include "core/device/force_watch.h"

#include <algorithm>

namespace haptrial::device {
namespace {

using control::SwingCounter;

constexpr double kAtTheLimit = 0.98;  // of it

// Near the limit.
constexpr double kShareOfLimit = 0.5;    // of the limit, peak to peak
constexpr double kNear = 0.7;            // of the limit
constexpr double kGapNearLimit = 0.080;  // [s]
constexpr int kTurnsNearLimit = 5;
constexpr double kLastingNearLimit = 0.065;  // [s]

// Anywhere: what no hand does by itself.
constexpr double kSwing = 2.0;       // peak to peak [N]
constexpr double kGap = 1.0 / 30.0;  // between the turns of 15 Hz [s]
constexpr double kLasting = 0.2;     // [s]

/// A swing that dies away does so by itself, as after a knock.
bool stays(const SwingCounter::Alternation& train) noexcept {
  constexpr double kDying = 0.96;  // of the swing before
  return train.turned && train.swing >= kDying * train.swing_before;
}

}  // namespace

ForceWatch::ForceWatch(double limit, double longest) noexcept
    : limit_(limit),
      longest_(longest),
      at_limit_(kShareOfLimit * limit, kGapNearLimit),
      swings_(kSwing, kGap) {}

Fault ForceWatch::look(const Eigen::Vector3d& force, const Eigen::Vector3d& stimulus,
                       double dt) noexcept {
  saturated_for_ = force.norm() >= kAtTheLimit * limit_ ? saturated_for_ + dt : 0.0;
  const SwingCounter::Alternation near = at_limit_.look(force, stimulus, dt);
  const SwingCounter::Alternation any = swings_.look(force, stimulus, dt);
  const bool near_limit = near.turns >= kTurnsNearLimit && near.lasted >= kLastingNearLimit &&
                          near.largest > kNear * limit_;
  if ((near_limit && stays(near)) || (any.lasted >= kLasting && stays(any))) {
    return Fault::kOscillation;
  }
  return saturated_for_ > longest_ ? Fault::kSaturation : Fault::kNone;
}

namespace {

constexpr double kAllowed = 0.15;    // [J]
constexpr double kForgotten = 0.15;  // [W]

}  // namespace

bool EnergyWatch::look(const Eigen::Vector3d& force, const Eigen::Vector3d& moved,
                       const ForceIntent& intent, double dt) noexcept {
  work_ += (force - intent.push).dot(moved - dt * intent.drive) - intent.added;
  given_ = work_ + intent.stored;
  lowest_ = begun_ ? std::min(given_, lowest_ + kForgotten * dt) : given_;
  begun_ = true;
  return generated() > kAllowed;
}

}  // namespace haptrial::device
