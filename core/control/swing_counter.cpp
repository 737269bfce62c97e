#include "core/control/swing_counter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace haptrial::control {
namespace {

constexpr double kAlternates = 5.0;  // what is accounted for alternates above this [Hz]
constexpr double kPeakMemory = 0.1;  // [s]

}  // namespace

SwingCounter::Alternation SwingCounter::look(const Eigen::Vector3d& force,
                                             const Eigen::Vector3d& accounted, double dt) noexcept {
  time_ += dt;
  const double swing = least_swing_ + accounted_swing(accounted, dt);
  const bool first = !std::exchange(begun_, true);
  Alternation longest;
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double rest = force[i] - accounted[i];
    if (first) {
      axis.highest = axis.lowest = {rest, time_, time_};
    }
    look_at(axis, rest, swing);
    const bool longer = axis.train.turns > longest.turns ||
                        (axis.train.turned && axis.train.turns == longest.turns);
    if (longer) {
      longest = axis.train;
    }
  }
  return longest;
}

/// Peak to peak.
double SwingCounter::accounted_swing(const Eigen::Vector3d& accounted, double dt) noexcept {
  if (peak_ == 0.0 && slow_.isZero(0.0) && accounted.isZero(0.0)) {
    return 0.0;  // as in most experiments
  }
  slow_ += std::min(1.0, 2.0 * std::numbers::pi * kAlternates * dt) * (accounted - slow_);
  const double fading = peak_ - std::min(1.0, dt / kPeakMemory) * peak_;
  peak_ = std::max(fading, (accounted - slow_).norm());
  return 2.0 * peak_;
}

void SwingCounter::look_at(Axis& axis, double force, double swing) const noexcept {
  axis.train.turned = false;
  if (force >= axis.highest.force) {
    axis.highest = {force, force > axis.highest.force ? time_ : axis.highest.from, time_};
  }
  if (force <= axis.lowest.force) {
    axis.lowest = {force, force < axis.lowest.force ? time_ : axis.lowest.from, time_};
  }
  if (axis.direction >= 0 && axis.highest.force - force >= swing) {
    axis.direction = -1;
    note_turn(axis, axis.highest);
  } else if (axis.direction <= 0 && force - axis.lowest.force >= swing) {
    axis.direction = 1;
    note_turn(axis, axis.lowest);
  } else {
    if (time_ - axis.turned_at > 2.0 * longest_gap_) {  // the next turn may have been already
      axis.train = {};
    }
    return;
  }
  axis.highest = axis.lowest = {force, time_, time_};
}

void SwingCounter::note_turn(Axis& axis, const Extreme& extreme) const noexcept {
  Alternation& train = axis.train;
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
