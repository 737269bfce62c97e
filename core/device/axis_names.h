#pragma once

#include <string>
#include <vector>

namespace haptrial::device {

/// Absolute axes of Linux input devices by the kernel's names, those that a pedal may have.
const std::vector<std::string>& axis_names();

/// The kernel's number of an axis; -1: no such name.
int axis_of(const std::string& name);

/// "ABS_GAS"; "axis 60" if the number has no name here.
std::string axis_name(int axis);

}  // namespace haptrial::device
