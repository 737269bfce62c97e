#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/phases/phase_model.h"

namespace haptrial::analysis::drilling {

/// Labelled time, by the label and by the phase that a model found.
struct PhaseAccuracy {
  Eigen::MatrixXd ticks;  // (label x found)

  /// Share of the time whose phase was found; 0 without any.
  double right() const;
  /// Share that the most frequent label has: whoever always says it is right so often.
  double chance() const;
  /// Cohen's kappa: 1 where all is right, 0 where no more is right than by chance.
  double kappa() const;
};

/// Holds the phases that a model finds against the labels, each participant's by a model of the
/// others. Undefined where learn_phases() is for one of them, or with fewer than two participants.
Defined<PhaseAccuracy> left_out_accuracy(std::span<const PhaseCase> cases,
                                         const std::vector<std::string>& phases);

}  // namespace haptrial::analysis::drilling
