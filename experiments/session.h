#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/realtime/servo_loop.h"
#include "core/record/session_types.h"
#include "experiments/bone_definition.h"
#include "experiments/definition.h"
#include "experiments/drilled_procedure.h"
#include "experiments/rig.h"
#include "experiments/session_control.h"

namespace haptrial::experiments {

/// One participant's session: the unit of work. What it records is a pure function of definition,
/// subject and seed on a simulated clock.
struct SessionRequest {
  const Definition* definition{nullptr};  // of one of the two protocols
  const BoneDefinition* bone{nullptr};
  std::string subject;    // identifier, such as "S01"
  int participant{0};     // from 0; chooses the order of conditions
  std::uint64_t seed{0};  // of the study
  realtime::ClockKind clock{realtime::ClockKind::kSimulated};
  std::filesystem::path file;
  int frames_per_pass{0};  // pictures of what was shown, into frames_folder
  std::filesystem::path frames_folder;
  int max_trials{0};                           // of the study proper; 0: all
  std::atomic<std::uint64_t>* ticks{nullptr};  // counts what is done, for a progress line
  const std::atomic<bool>* cancel{nullptr};  // set from outside to end early, as an interrupt does

  // Sessions on the real clock.
  DeviceChoice device;
  SessionControl* control{nullptr};  // of an experimenter at a console or keyboard
  bool window{false};                // the participant's screen
  bool stream{false};                // to the Lab Streaming Layer
  bool stream_optional{false};       // go on without where the layer is absent
  bool resume{false};                // go on with FILE.partial where there is one
  bool pilot{false};                 // no part of the study
  /// Lines for whoever watches the terminal, while the session runs; from the session's thread.
  std::function<void(const std::string&)> tell;
  record::Participant person;
};

inline const Setup& setup_of(const SessionRequest& request) {
  return request.bone != nullptr ? static_cast<const Setup&>(*request.bone) : *request.definition;
}

struct SessionSummary {
  std::uint64_t ticks{0};
  int passes{0};  // in this run
  int aborted_passes{0};
  std::uint64_t overruns{0};
  std::uint64_t dropped{0};
  bool simulated{false};                     // the device
  bool stopped{false};                       // trials are left, and --resume goes on with them
  std::vector<DrilledProcedure> procedures;  // those of this run; on the real clock, or attended
  std::vector<std::string> notices;          // sentences: real time, screen, streams
};

/// Runs the session and writes its file. One that had ended and was killed before its file had its
/// name is only closed. On an interrupt or a failure of a simulated session
/// nothing is left; a session on the real clock keeps what it recorded as FILE.partial.
/// @throws RunError, InputError
SessionSummary run_session(const SessionRequest& request);

/// Ticks that a session takes at most on a simulated clock, roughly; for a progress line.
double estimated_ticks(const Definition& definition, int trials);
double estimated_ticks(const BoneDefinition& definition, int trials);

}  // namespace haptrial::experiments
