#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/realtime/servo_loop.h"
#include "experiments/definition.h"

namespace haptrial::experiments {

/// One participant's session: the unit of work. What it records is a pure function of definition,
/// subject and seed on a simulated clock.
struct SessionRequest {
  const Definition* definition{nullptr};
  std::string subject;    // identifier, such as "S01"
  int participant{0};     // from 0; chooses the order of conditions
  std::uint64_t seed{0};  // of the study
  realtime::ClockKind clock{realtime::ClockKind::kSimulated};
  std::filesystem::path file;
  int frames_per_pass{0};  // pictures of what was shown, into frames_folder
  std::filesystem::path frames_folder;
  int max_trials{0};                           // 0: all
  std::atomic<std::uint64_t>* ticks{nullptr};  // counts what is done, for a progress line
  const std::atomic<bool>* cancel{nullptr};  // set from outside to end early, as an interrupt does
};

struct SessionSummary {
  std::uint64_t ticks{0};
  int passes{0};
  int aborted_passes{0};
  std::uint64_t overruns{0};
  std::uint64_t dropped{0};
  std::string notice;  // of the real-time set-up; empty where nothing was refused
};

/// Runs the session and writes its file. On an interrupt or a failure of a simulated session
/// nothing is left; a session on the real clock keeps what it recorded as FILE.partial.
/// @throws RunError, InputError
SessionSummary run_session(const SessionRequest& request);

/// Ticks that a session takes at most on a simulated clock, roughly; for a progress line.
double estimated_ticks(const Definition& definition, int trials);

}  // namespace haptrial::experiments
