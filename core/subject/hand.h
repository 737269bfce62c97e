#pragma once

#include <array>

#include "core/subject/hand_model.h"
#include "core/subject/hand_parameters.h"

namespace haptrial::subject {

/// A hand that holds a handle. Integrated by an exact step of the linear part (matrix exponential,
/// inputs held over the step); Coulomb friction is the force, within its bound, that brings each
/// axis to rest by the end of the step. The step size is fixed at construction.
/// Source: Morris 2006 names no hand model; docs/algorithms/virtual-subject.md cites ours.
class Hand final : public HandModel {
 public:
  /// @param step  size of every step > 0 [s]
  Hand(const HandParameters& parameters, double step, const Eigen::Vector3d& start);

  void command(const HandCommand& command) noexcept override { command_ = command; }
  PointState step(const Eigen::Vector3d& motor_force, double dt) noexcept override;
  PointState state() const noexcept override;

 private:
  struct ExactStep {
    Eigen::Matrix<double, 5, 5> state;
    Eigen::Matrix<double, 5, 2> input;
  };
  static ExactStep exact_step(const AxisDynamics& dynamics, double dt);

  ExactStep yielding_;
  ExactStep holding_;
  double friction_;
  HandCommand command_;
  std::array<AxisState, 3> axes_;
};

}  // namespace haptrial::subject
