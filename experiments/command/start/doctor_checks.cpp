#include "experiments/command/start/doctor_checks.h"

#include <optional>
#include <utility>

#include "core/base/error.h"
#include "experiments/command/start/touch_checks.h"
#include "experiments/runner/participant_input.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {
namespace {

constexpr double kClockSeconds = 2.0;
constexpr double kUsualRate = 1000.0;  // [Hz]

/// Marks what sessions of a definition do without.
void mark_unused(const protocols::Definition& definition, std::vector<MachineCheck>& checks) {
  for (MachineCheck& check : checks) {
    const bool sound = check.what == "sound" && !definition.is_heard();
    const bool beside = check.what == "video" || check.what == "stream";  // asked for by options
    if ((sound || beside) && check.state != MachineCheck::State::kReady) {
      check.state = MachineCheck::State::kUnused;
    }
  }
}

/// Opens the pedal as a session with a person does.
MachineCheck check_pedal(const protocols::Definition& definition) {
  try {
    SessionPedal pedal({"", "", 0}, definition, true);
    return pedal.pedal() != nullptr
               ? MachineCheck{"pedal", MachineCheck::State::kReady, pedal.pedal()->input()}
               : MachineCheck{"pedal", MachineCheck::State::kUnused, pedal.notice()};
  } catch (const InputError& error) {
    return {"pedal", MachineCheck::State::kBroken, error.what()};
  }
}

}  // namespace

std::vector<MachineCheck> doctor_checks(const protocols::Definition* definition,
                                        const std::filesystem::path& folder) {
  const double rate = definition != nullptr ? definition->rate : kUsualRate;
  std::vector<MachineCheck> checks{check_clock(kClockSeconds, rate),
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
  const TouchSearch here = this_machine(
      definition != nullptr ? std::optional(definition->vendor.open_haptics.name) : std::nullopt);
  for (MachineCheck& touch : check_touch(here)) {
    checks.push_back(std::move(touch));
  }
  if (definition != nullptr) {
    if (definition->pedal_use() != protocols::PedalUse::kNone) {
      checks.push_back(check_pedal(*definition));
    }
    mark_unused(*definition, checks);
  }
  return checks;
}

}  // namespace haptrial::experiments
