#include "core/subject/hand_parameters.h"

#include "core/base/definition/schema.h"

namespace haptrial::subject {

const Schema<HandParameters>& hand_schema() {
  using P = HandParameters;
  static const auto schema =
      Schema<P>()
          .number("handle_mass", &P::handle_mass, {0.001, 10.0}, "kg",
                  "Mass of the device's handle, which moves with the hand")
          .required()
          .number("coulomb_friction", &P::coulomb_friction, {0.0, 10.0}, "N",
                  "Coulomb friction of the device's handle")
          .required()
          .number("hand_mass", &P::hand_mass, {0.001, 10.0}, "kg",
                  "Mass of a virtual participant's hand")
          .required()
          .number("damping", &P::damping, {0.0, 1000.0}, "N·s/m",
                  "Damping of a virtual participant's grip")
          .required()
          .number("stiffness", &P::stiffness, {0.0, 1e5}, "N/m",
                  "Stiffness of a virtual participant's grip")
          .required()
          .number("posture_time", &P::posture_time, {0.001, 100.0}, "s",
                  "Time constant at which a virtual hand's posture yields to a lasting force")
          .required()
          .number("excitation_time", &P::excitation_time, {0.001, 1.0}, "s",
                  "Time constant of the muscles' excitation")
          .required()
          .number("activation_time", &P::activation_time, {0.001, 1.0}, "s",
                  "Time constant of the muscles' activation")
          .required();
  return schema;
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
