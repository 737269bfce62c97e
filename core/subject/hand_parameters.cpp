#include "core/subject/hand_parameters.h"

#include "core/base/definition/table.h"

namespace haptrial::subject {

HandParameters read_hand_parameters(Table& table) {
  HandParameters p;
  p.handle_mass = table.number("handle_mass", {0.001, 10.0}, "kg");
  p.coulomb_friction = table.number("coulomb_friction", {0.0, 10.0}, "N");
  p.hand_mass = table.number("hand_mass", {0.001, 10.0}, "kg");
  p.damping = table.number("damping", {0.0, 1000.0}, "N·s/m");
  p.stiffness = table.number("stiffness", {0.0, 1e5}, "N/m");
  p.posture_time = table.number("posture_time", {0.001, 100.0}, "s");
  p.excitation_time = table.number("excitation_time", {0.001, 1.0}, "s");
  p.activation_time = table.number("activation_time", {0.001, 1.0}, "s");
  return p;
}

AxisDynamics axis_dynamics(const HandParameters& p, bool posture_yields) {
  const double mass = p.handle_mass + p.hand_mass;
  AxisDynamics d;
  d.system.setZero();
  d.system(0, 1) = 1.0;
  d.system.row(1) << -p.stiffness / mass, -p.damping / mass, p.stiffness / mass, 0.0, 1.0 / mass;
  if (posture_yields) {
    d.system(2, 0) = 1.0 / p.posture_time;
    d.system(2, 2) = -1.0 / p.posture_time;
  }
  d.system(3, 3) = -1.0 / p.excitation_time;
  d.system(4, 3) = 1.0 / p.activation_time;
  d.system(4, 4) = -1.0 / p.activation_time;
  d.input.setZero();
  d.input(1, 0) = 1.0 / mass;
  d.input(3, 1) = 1.0 / p.excitation_time;
  return d;
}

}  // namespace haptrial::subject
