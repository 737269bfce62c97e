#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/command/start/machine_checks.h"

namespace haptrial::experiments {

/// Where a Touch and its vendor's software are looked for.
struct TouchSearch {
  std::filesystem::path root;             // above dev, etc, sys and usr
  std::filesystem::path home;             // of the user
  std::string gtdd_home;                  // the variable GTDD_HOME; empty: not set
  std::optional<std::string> definition;  // `name` of its [open_haptics]; nothing without one
  /// Whether the user may read and write a file below `root`.
  std::function<bool(const std::filesystem::path&)> may_open;
};

/// This machine and this user. @param definition  as in TouchSearch
TouchSearch this_machine(std::optional<std::string> definition);

/// Checks a 3D Systems Touch on USB: its device file and the right to open it, the vendor's library
/// and driver, GTDD_HOME, a configuration folder that is left over, and the name to give.
/// @returns nothing if neither a Touch nor its library is there, and one line if it is not plugged
///          in
std::vector<MachineCheck> check_touch(const TouchSearch& search);

}  // namespace haptrial::experiments
