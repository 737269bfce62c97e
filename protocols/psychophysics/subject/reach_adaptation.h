#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/subject/perceiver/two_rate.h"
#include "protocols/psychophysics/definition/cursor_parameters.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "protocols/psychophysics/subject/observer_plan.h"

namespace haptrial::protocols {

/// How a virtual participant's reaches adapt, to a field of force or to a cursor that is turned.
///
/// The error of a reach with a cursor is the angle about `about` by which the cursor ends beside
/// the place that was aimed at, f - x for a rotation f of which x [rad] is compensated; the next
/// reach is aimed by -x beside it. A cursor that is not shown teaches nothing.
/// Servo thread, but for the constructor and recall().
class ReachAdaptation {
 public:
  ReachAdaptation(const Adaptation& plan, const ScreenPlane& screen);
  void recall(double fast, double slow) noexcept { learnt_.recall(fast, slow); }

  void begin_reach() noexcept;
  /// The place to reach for, so that what is seen or felt brings the hand or cursor to the mark.
  Eigen::Vector3d aim(const Eigen::Vector3d& mark, const TrialView& view) noexcept;
  /// A tick of the reach. @param force  on the hand [N]; @param velocity  that is meant [m/s]
  void feel(const TrialView& view, const Eigen::Vector3d& force,
            const Eigen::Vector3d& velocity) noexcept;
  /// The arm's force against the field that is expected [N].
  Eigen::Vector3d compensation(const Eigen::Vector3d& velocity) const noexcept;
  void end_reach() noexcept { learnt_.learn(error()); }
  /// What is known if the reach ends now.
  subject::TwoRate after_reach() const noexcept;
  const subject::TwoRate& learnt() const noexcept { return learnt_; }

 private:
  double error() const noexcept { return felt_ ? felt_->error() : seen_; }

  std::optional<Eigen::Matrix3d> field_;
  subject::TwoRate learnt_;
  std::optional<subject::FieldError> felt_;
  ScreenPlane screen_;
  std::optional<Eigen::Vector3d> mark_;  // of this reach
  double seen_{0.0};                     // error of the cursor so far [rad]
};

}  // namespace haptrial::protocols
