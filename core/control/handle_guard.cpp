#include "core/control/handle_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace haptrial::control {
namespace {

constexpr double kSwing = 1.5;            // peak to peak [N]
constexpr double kLargeSwing = 2.0;       // [N]
constexpr double kNoTremor = 4.0;         // [N]
constexpr double kOfATremor = 3.0;        // reached once, in resonance with a wall [N]
constexpr double kLongestGap = 0.062;     // between turns; those of a slower hand are its own [s]
constexpr double kOfAHand = 0.036;        // turns of a tremor, 8 to 12 Hz, are longer apart [s]
constexpr int kTurns = 3;                 // that make an oscillation
constexpr int kLargeTurns = 2;            // the same, if large
constexpr double kStep = 1.2;             // of g, for each turn and each N of its swing
constexpr int kTurnsInCalm = 2;           // slow ones that do not die away, before anything goes
constexpr int kTurnsWithoutDamping = 2;   // that do not die away, before stiffness gives way
constexpr double kStiffnessStep = 2.5;    // of g above kStiffnessFrom, for each turn
constexpr double kDying = 0.96;           // of the swing before
constexpr double kForDying = 1.5;         // g at most, for what dies away by itself
constexpr double kRemembered = 2.0;       // [s]
constexpr double kStiffnessFrom = 3.0;    // g above which stiffness gives way
constexpr double kMostGiven = 8.0;        // g
constexpr double kMargin = 0.4;           // of g, over what was too little
constexpr double kQuiet = 0.08;           // without a turn [s]
constexpr double kGivingBack = 7.5;       // of g [1/s]
constexpr double kTryingAnew = 0.2;       // of what was too little, damping [1/s]
constexpr double kTryingStiffness = 0.3;  // [1/s]
constexpr double kCalmingEnds = 0.5;      // of c [1/s]
constexpr double kFastest = 80.0;  // change of a share, so that 6 N change by 0.5 N in 1 ms [1/s]
constexpr double kSlow = 4.0;      // a hand's own movement ends about there [Hz]

/// A step of the encoder must not be felt as a knock.
double calm_damping(const HandleLoop& loop) {
  constexpr double kLargestKnock = 0.25;  // [N]
  const double carried = damping_of_bare_handle(std::numeric_limits<double>::infinity(), loop);
  return loop.velocity_step > 0.0 ? std::min(carried, kLargestKnock / loop.velocity_step) : carried;
}

}  // namespace

HandleGuard::HandleGuard(const HandleLoop& loop)
    : calm_damping_(calm_damping(loop)), turns_(kSwing, kLongestGap) {
  if (!(loop.handle_mass > 0.0 && loop.rate > 0.0) || loop.velocity_window < 2) {
    throw std::invalid_argument(
        "HandleGuard: handle_mass and rate must be above 0 and velocity_window at least 2");
  }
}

const GainShares& HandleGuard::watch(const Eigen::Vector3d& velocity, const Eigen::Vector3d& force,
                                     const Eigen::Vector3d& accounted, double dt) noexcept {
  const SwingCounter::Alternation train = turns_.look(force, accounted, dt);
  quiet_for_ += dt;
  if (oscillates(train)) {
    give_way(train);
    quiet_for_ = 0.0;
  } else if (quiet_for_ > kQuiet) {
    recover(dt);
  }
  const auto go_towards = [dt](double& share, double wanted) {
    share += std::clamp(wanted - share, -kFastest * dt, kFastest * dt);
  };
  const GainShares wanted = wanted_shares();
  go_towards(shares_.damping, wanted.damping);
  go_towards(shares_.stiffness, wanted.stiffness);
  go_towards(calm_now_, calm_);
  calm(velocity, dt);
  return shares_;
}

GainShares HandleGuard::wanted_shares() const noexcept {
  return {std::exp(-std::max(0.0, given_ - kStiffnessFrom)), std::exp(-given_)};
}

bool HandleGuard::settled() const noexcept {
  constexpr double kNearly = 0.02;
  const GainShares wanted = wanted_shares();
  return shares_.damping < wanted.damping + kNearly &&
         shares_.stiffness < wanted.stiffness + kNearly;
}

/// A hand may shake by itself against what is stiff, if slowly: that is calmed, and nothing goes.
bool HandleGuard::oscillates(const SwingCounter::Alternation& train) noexcept {
  const bool large = train.swing >= kLargeSwing;
  if (!train.turned || train.turns < (large ? kLargeTurns : kTurns)) {
    return false;
  }
  if (train.gap <= kOfAHand) {
    slow_turns_ = 0;
    return true;
  }
  calm_ = 1.0;
  const bool dies = train.swing < kDying * train.swing_before;
  slow_turns_ = dies || train.swing < kOfATremor ? 0 : slow_turns_ + 1;
  return slow_turns_ >= kTurnsInCalm || (slow_turns_ > 0 && train.swing >= kNoTremor);
}

/// A swing that dies away by itself, as after a knock, is only damped.
void HandleGuard::give_way(const SwingCounter::Alternation& train) noexcept {
  if (!settled()) {
    still_ = 0;
    return;  // what was given up last has not come to act
  }
  const bool dies = train.swing < kDying * train.swing_before;
  still_ = dies ? 0 : still_ + 1;
  if (recovers_ && !dies) {
    too_little_ = std::min(kMostGiven, std::max(too_little_, given_ + kMargin));
    recovers_ = false;
  }
  if (given_ >= kStiffnessFrom) {
    if (still_ >= kTurnsWithoutDamping) {
      given_ = std::min(kMostGiven, given_ + kStiffnessStep);
      still_ = 0;
    }
    return;
  }
  const double most = dies ? kForDying : kStiffnessFrom;
  given_ = std::max(given_, std::min(most, given_ + kStep * train.swing));
}

void HandleGuard::recover(double dt) noexcept {
  calm_ = std::max(0.0, calm_ - kCalmingEnds * dt);
  remembered_for_ = given_ > 0.0 ? 0.0 : remembered_for_ + dt;
  recovers_ = remembered_for_ < kRemembered && (recovers_ || given_ > 0.0);
  const double anew = too_little_ > kStiffnessFrom ? kTryingStiffness : kTryingAnew;
  too_little_ = std::max(0.0, too_little_ - anew * dt);
  given_ = std::max(std::min(given_, too_little_), given_ - kGivingBack * dt);
}

void HandleGuard::calm(const Eigen::Vector3d& velocity, double dt) noexcept {
  const Eigen::Vector3d v = velocity.allFinite() ? velocity : Eigen::Vector3d(slow_);
  slow_ += std::min(1.0, 2.0 * std::numbers::pi * kSlow * dt) * (v - slow_);
  calming_ = -std::max(1.0 - shares_.damping, calm_now_) * calm_damping_ * (v - slow_);
}

}  // namespace haptrial::control
