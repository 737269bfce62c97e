#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/device/least_squares.h"

namespace haptrial::analysis {

/// Signals of a free handle's movement along one axis, and the times at which the model is compared
/// with them.
struct FreeSignals {
  static constexpr double kMostDelay = 0.02;  // that a model may have [s]

  double rate;                                   // [Hz]
  std::vector<double> command, position, speed;  // of each tick [N, m, m/s]
  Eigen::VectorXd smoothing;         // weights with which second differences are averaged
  std::vector<long> windows;         // middles of the windows in which the handle never stood still
  std::vector<double> acceleration;  // mean of each window with these weights [m/s^2]
};

/// A model of the acceleration and its parameters, as fitted. The parts that motion does not show
/// clearly are not in it.
struct FreeModel {
  /// Delay in ms; mobility in 1/kg; the others in commanded newtons.
  enum Parameter : int { kMobility, kDelay, kFriction, kDeadZone, kOffset, kPlain };
  bool resonance{false};  // then its frequency [100 Hz] and damping follow
  bool cogging{false};    // then its cosine, sine [commanded N] and frequency [1/m] come last
  FittedParameters fit;

  int count() const { return kPlain + (resonance ? 2 : 0) + (cogging ? 3 : 0); }
  int first_of_resonance() const { return kPlain; }
  int first_of_cogging() const { return count() - 3; }
};

/// Least squares over the windows, from a model without resonance and cogging to the richest one
/// that clearly explains more.
/// @param signals  of more than 20 windows
FreeModel fit_free_model(const FreeSignals& signals);

/// Size of a change of each of the model's parameters that matters (parameters).
Eigen::VectorXd scale_of(const FreeSignals& signals, const FreeModel& model);

}  // namespace haptrial::analysis
