#include <fmt/format.h>

#include <algorithm>

#include "experiments/command/start/machine_checks.h"
#include "experiments/command/start/start_commands.h"

namespace haptrial::experiments {
namespace {

constexpr double kClockSeconds = 2.0;

const char* word_of(MachineCheck::State state) {
  switch (state) {
    case MachineCheck::State::kReady:
      return "ready";
    case MachineCheck::State::kLimited:
      return "limited";
    case MachineCheck::State::kAbsent:
      return "absent";
    case MachineCheck::State::kBroken:
      break;
  }
  return "BROKEN";
}

}  // namespace

int doctor(const std::string& folder) {
  std::vector<MachineCheck> checks{check_clock(kClockSeconds),
                                   check_real_time(),
                                   check_off_screen(),
                                   check_window(),
                                   check_sound(),
                                   check_video(),
                                   check_stream(),
                                   check_disk(folder)};
  for (MachineCheck& device : check_devices()) {
    checks.push_back(std::move(device));
  }
  std::ranges::stable_sort(checks, {}, &MachineCheck::state);  // what asks for something first
  for (const MachineCheck& check : checks) {
    fmt::print("{:<15}  {:<7}  {}\n", check.what, word_of(check.state), check.found);
  }
  const auto broken =
      std::ranges::count(checks, MachineCheck::State::kBroken, &MachineCheck::state);
  fmt::print("\n{}\n", broken == 0 ? "Sessions and dry runs can run here."
                                   : "Sessions cannot run here before what is broken is mended.");
  return broken == 0 ? 0 : 1;
}

}  // namespace haptrial::experiments
