#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "core/control/sampled_curve.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

/// Places of a hand along its path, tick by tick.
struct HandPlaces {
  std::vector<double> along;     // the path, as the time that it takes at its own speed [s]
  std::vector<double> distance;  // from the path, without the direction of the force, y [m]
};

/// Finds a hand's places on the ideal path of a block again, as the servo loop found them: the
/// nearest that continues the place before (control::CurveTracker). For passes in which the
/// participant set the pace; the file holds positions, and the place follows from them.
class PathPlaces {
 public:
  /// @param rows  of one block, in order of time. @throws std::invalid_argument for fewer than two.
  explicit PathPlaces(std::span<const record::StimulusRow> rows);

  /// @param positions  p_W of one run from the path's start on [m]
  HandPlaces of(std::span<const Eigen::Vector3d> positions) const;
  double duration() const { return times_.back(); }  // at the path's speed [s]

 private:
  std::vector<double> times_;  // of the rows [s]
  std::unique_ptr<control::SampledCurve> curve_;
};

/// A force over the place on the path, in place of time: what was applied while the hand was within
/// a cell of 5 ms of the path at its own speed, as a mean over the ticks that it spent there,
/// however fast or slow and in whichever direction. Straight lines over cells that it skipped.
/// Slopes and filter widths so keep the unit, and the meaning, that they have over time.
/// @param along  (ticks) [s];  @param force  (ticks) [N], equally long, not empty
/// @param duration  of the path at its speed > 0 [s]
ForceCurve over_path(std::span<const double> along, std::span<const double> force, double duration);

}  // namespace haptrial::analysis
