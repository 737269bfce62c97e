#include "protocols/psychophysics/definition/defaults.h"

namespace haptrial::protocols {

std::string_view trials_defaults() {
  return R"([experiment]
rate = 1000.0

[envelope]
max_force = 8.0
max_force_rate = 4000.0
workspace_radius = 0.075
max_speed = 1.5
max_jump = 0.005
ramp_in = 0.1
ramp_out = 0.1

[device]
max_force = 12.0
workspace_radius = 0.075
position_quantum = 1e-5
velocity_window = 8

[hand]
integrator = "exact"
handle_mass = 0.22
coulomb_friction = 0.1
hand_mass = 0.8
damping = 15.0
stiffness = 250.0
posture_time = 0.1
excitation_time = 0.030
activation_time = 0.040

[observer]

[screen]

[display]
seen_from = "front"
extent = 0.16
hand_radius = 0.003
feedback_right = "✓ Correct"
feedback_wrong = "✗ Wrong"
feedback_time = 0.6

[texts]
instructions = "Welcome\nFollow what you feel and answer what you are asked."
practice = "Practice\nThese trials do not count."
rest = "Time for a rest\nLet go of the handle."
thanks = "Thank you\nThe session is over."
)";
}

}  // namespace haptrial::protocols
