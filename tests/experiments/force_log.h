#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::test {

/// A force that a program commanded of the stand-in of a Force Dimension device.
struct Commanded {
  double time;   // of CLOCK_MONOTONIC [s]
  double force;  // its size [N]
};

/// Forces that a stand-in was given so far, also by a program that has died. @param file  as
/// STAND_IN_FORCES named it
std::vector<Commanded> read_force_log(const std::filesystem::path& file);

/// The time on the same clock. [s]
double monotonic_now();

}  // namespace haptrial::test
