#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"

namespace haptrial::subject {

/// A hand on a handle, along each axis of W. Sources of the values:
/// docs/algorithms/virtual-subject.md.
struct HandParameters {
  double handle_mass{0.22};      // moving mass of the device at the tool >= 0.001 [kg]
  double coulomb_friction{0.1};  // of the device >= 0 [N]
  double hand_mass{0.8};         // effective, at the grip >= 0.001 [kg]
  double damping{15.0};          // b >= 0 [N·s/m]
  double stiffness{250.0};       // k about the posture >= 0 [N/m]
  double posture_time{0.2};  // a yielding posture follows the hand with this constant >= 0.001 [s]
  double excitation_time{0.030};  // muscle, first lag >= 0.001 [s]
  double activation_time{0.040};  // muscle, second lag >= 0.001 [s]
};

/// The keys of [hand].
const Schema<HandParameters>& hand_schema();

/// State of one axis: position, velocity, posture, excitation, muscle force [m, m/s, m, N, N].
using AxisState = Eigen::Matrix<double, 5, 1>;

/// The linear dynamics of one axis,
///
///     m p'' = f - k (p - e) - b p' + a,    m = handle_mass + hand_mass
///     e'    = (p - e) / posture_time       where the posture yields, 0 where it holds
///     x'    = (u - x) / excitation_time,   a' = (x - a) / activation_time
///
/// as state' = system · state + input · (f, u), with f the outer force and u the motor command [N].
struct AxisDynamics {
  Eigen::Matrix<double, 5, 5> system;
  Eigen::Matrix<double, 5, 2> input;
};
AxisDynamics axis_dynamics(const HandParameters& parameters, bool posture_yields);

}  // namespace haptrial::subject
