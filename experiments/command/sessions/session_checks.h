#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/command/sessions/run_options.h"
#include "experiments/command/start/machine_checks.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

/// The session that comes next, and the checks before its first trial.
struct SessionChecks {
  std::string subject;  // who comes; empty: nobody is next
  std::string group;    // empty: the study has none
  int session{1};
  double seconds{0.0};  // that the session takes at most, breaks counted, pages not
  std::vector<MachineCheck> checks;

  /// No check is broken.
  bool ready() const;
};

/// Goes through what the program can check by itself before a session: participant, definition,
/// consent, machine, device and certificate, channels, disk, backup. It takes some seconds, opens
/// the channels for a moment and no device.
/// @param options  filled in with who is next, if they name nobody
SessionChecks session_checks(RunOptions& options, const Experiment& experiment);

/// How a study that may end early stands: one that has ended is not to go on by oversight. Nothing
/// for a pilot, for who has begun and may finish, and for a study without such a rule.
std::optional<MachineCheck> check_end_of_study(const RunOptions& options,
                                               const Experiment& experiment);

}  // namespace haptrial::experiments
