#include "core/control/swing_counter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace haptrial::control {
namespace {

constexpr double kAlternates = 5.0;  // what is accounted for alternates above this [Hz]
constexpr double kMemory = 0.1;      // of its size and its rate [s]
// An answer turns as often as what it answers to, within these shares of the time between turns.
constexpr double kAnswersFrom = 0.5;
constexpr double kAnswersUntil = 1.5;

}  // namespace

SwingCounter::Train SwingCounter::look(const Eigen::Vector3d& force,
                                       const Eigen::Vector3d& accounted, double dt) noexcept {
  time_ += dt;
  follow_accounted(accounted, dt);
  const bool first = !std::exchange(begun_, true);
  Train longest;
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double rest = force[i] - accounted[i];
    if (first) {
      axis.highest = axis.lowest = {rest, time_, time_};
    }
    look_at(axis, rest, peak_[i]);
    const bool longer = axis.train.turns > longest.turns ||
                        (axis.train.turned && axis.train.turns == longest.turns);
    if (longer) {
      longest = axis.train;
    }
  }
  return longest;
}

/// The time between turns is that between the zeros of a sine of the same mean squares
/// (Rice 1944).
void SwingCounter::follow_accounted(const Eigen::Vector3d& accounted, double dt) noexcept {
  if (peak_.isZero(0.0) && slow_.isZero(0.0) && accounted.isZero(0.0)) {
    return;  // as in most experiments
  }
  const Eigen::Vector3d before = alternating_;
  slow_ += std::min(1.0, 2.0 * std::numbers::pi * kAlternates * dt) * (accounted - slow_);
  alternating_ = accounted - slow_;
  const double fading = std::min(1.0, dt / kMemory);
  peak_ = (peak_ - fading * peak_).cwiseMax(alternating_.cwiseAbs());
  power_ += fading * (alternating_.squaredNorm() - power_);
  slope_power_ += fading * ((alternating_ - before).squaredNorm() / (dt * dt) - slope_power_);
  gap_ = slope_power_ > 0.0 ? std::numbers::pi * std::sqrt(power_ / slope_power_) : 0.0;
}

/// @param peak  of what is accounted for along this axis [N]
void SwingCounter::look_at(Axis& axis, double force, double peak) const noexcept {
  const double swing = least_swing_ + 2.0 * peak;
  axis.train.turned = false;
  if (force >= axis.highest.force) {
    axis.highest = {force, force > axis.highest.force ? time_ : axis.highest.from, time_};
  }
  if (force <= axis.lowest.force) {
    axis.lowest = {force, force < axis.lowest.force ? time_ : axis.lowest.from, time_};
  }
  if (axis.direction >= 0 && axis.highest.force - force >= swing) {
    axis.direction = -1;
    note_turn(axis, axis.highest, peak);
  } else if (axis.direction <= 0 && force - axis.lowest.force >= swing) {
    axis.direction = 1;
    note_turn(axis, axis.lowest, peak);
  } else {
    if (time_ - axis.turned_at > 2.0 * longest_gap_) {  // the next turn may have been already
      axis.train = {};
    }
    return;
  }
  axis.highest = axis.lowest = {force, time_, time_};
}

/// Whether this turn is an answer to what is accounted for.
bool SwingCounter::answers(Axis& axis, const Extreme& extreme, double peak) const noexcept {
  const double at = 0.5 * (extreme.from + extreme.until);
  const double gap = at - std::exchange(axis.last_at, at);
  const double swing = std::abs(extreme.force - std::exchange(axis.last_from, extreme.force));
  return gap >= kAnswersFrom * gap_ && gap <= kAnswersUntil * gap_ &&
         swing < least_swing_ + peak_.norm() + peak;
}

void SwingCounter::note_turn(Axis& axis, const Extreme& extreme, double peak) const noexcept {
  if (answers(axis, extreme, peak)) {
    return;
  }
  Train& train = axis.train;
  const double at = 0.5 * (extreme.from + extreme.until);
  train.gap = at - axis.turned_at;
  train.swing_before = train.swing;
  train.swing = std::abs(extreme.force - axis.turned_from);
  train.largest = std::max(std::abs(extreme.force), std::abs(axis.turned_from));
  const bool follows = train.turns > 0 && train.gap <= longest_gap_;
  train.turns = follows ? train.turns + 1 : 1;
  train.lasted = follows ? train.lasted + train.gap : 0.0;
  train.turned = true;
  axis.turned_at = at;
  axis.turned_from = extreme.force;
}

}  // namespace haptrial::control
