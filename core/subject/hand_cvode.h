#pragma once

#include <memory>

#include "core/subject/hand_model.h"
#include "core/subject/hand_parameters.h"

namespace haptrial::subject {

/// The same hand integrated by SUNDIALS CVODE (BDF), with Coulomb friction as the smooth law
/// -f_c tanh(v / v_s): stiff and nonlinear, about a hundred times slower than Hand. The reference
/// that Hand is tested against, and the choice `integrator = "cvode"` of a definition.
/// Allocates while it steps: for simulated clocks only.
class CvodeHand final : public HandModel {
 public:
  /// @param slip_speed  v_s > 0 [m/s]
  /// @throws RunError when CVODE cannot be set up.
  CvodeHand(const HandParameters& parameters, double slip_speed, double tolerance,
            const Eigen::Vector3d& start);
  ~CvodeHand() override;

  void command(const HandCommand& command) noexcept override;
  PointState step(const Eigen::Vector3d& motor_force, double dt) noexcept override;
  PointState state() const noexcept override;
  /// False after CVODE failed a step; the state then rests at its last good value.
  bool ok() const noexcept;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace haptrial::subject
