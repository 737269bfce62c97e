#pragma once

#include <string>

namespace haptrial::test {

/// A definition of trials with a pull to the right that is felt or not, and two places to touch.
/// @param response  lines of [response]: its choices, and what else it has
inline std::string felt_or_not(const std::string& response) {
  return R"([experiment]
protocol = "trials"
name = "felt"
[design]
participants = 1
[fields.pull]
type = "constant"
force = ["$level", 0.0, 0.0]
[fields.home]
type = "minimum_jerk"
to = [0.0, 0.0, 0.0]
duration = 0.4
stiffness = 300.0
damping = 20.0
[regions.left]
type = "sphere"
centre = [-0.03, 0.0, 0.0]
radius = 0.01
[regions.right]
type = "box"
centre = [0.03, 0.0, 0.0]
size = [0.02, 0.02, 0.02]
[[stages]]
name = "home"
fields = ["home"]
until = { time = 0.6 }
[[stages]]
name = "rest"
until = { time = 0.1 }
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.4 }
[procedure]
kind = "constant"
variable = "level"
levels = [0.02, 1.0]
repetitions = 6
counts = "$answer == 1"
[observer]
decides = "yes"
in_stage = "feel"
criterion = 0.4
force_floor = 0.02
[observer.actions]
feel = { do = "hold" }
[response]
question = "Did it pull?"
)" + response;
}

}  // namespace haptrial::test
