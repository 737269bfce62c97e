#include "protocols/psychophysics/subject/reach_adaptation.h"

#include <cmath>

namespace haptrial::protocols {
namespace {

Eigen::Vector3d place_of(const std::array<float, 3>& p) {
  return Eigen::Vector3f(p[0], p[1], p[2]).cast<double>();
}

}  // namespace

ReachAdaptation::ReachAdaptation(const Adaptation& plan, const ScreenPlane& screen)
    : field_(plan.field), learnt_(plan.rates), screen_(screen) {
  if (field_) {
    felt_.emplace(*field_);
  }
}

void ReachAdaptation::begin_reach() noexcept {
  seen_ = 0.0;
  if (felt_) {
    felt_->begin();
  }
}

Eigen::Vector3d ReachAdaptation::aim(const Eigen::Vector3d& mark, const TrialView& view) noexcept {
  mark_ = mark;
  const Eigen::Vector3d about = place_of(view.cursor_about);
  return felt_ ? mark : Eigen::Vector3d(about + screen_.turned(mark - about, -learnt_.state()));
}

void ReachAdaptation::feel(const TrialView& view, const Eigen::Vector3d& force,
                           const Eigen::Vector3d& velocity) noexcept {
  if (felt_) {
    felt_->feel(force, compensation(velocity), velocity);
  } else if (view.cursor_shown && mark_) {
    constexpr double kNear = 0.005;  // a way that has no direction yet [m]
    const Eigen::Vector3d about = place_of(view.cursor_about);
    const Eigen::Vector3d way = place_of(view.cursor) - about;
    if (screen_.length_of(way) > kNear) {
      seen_ = std::remainder(screen_.angle_of(way) - screen_.angle_of(*mark_ - about), 2.0 * M_PI);
    }
  }
}

Eigen::Vector3d ReachAdaptation::compensation(const Eigen::Vector3d& velocity) const noexcept {
  return field_ ? learnt_.compensation(*field_, velocity)
                : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

subject::TwoRate ReachAdaptation::after_reach() const noexcept {
  subject::TwoRate after = learnt_;
  after.learn(error());
  return after;
}

}  // namespace haptrial::protocols
