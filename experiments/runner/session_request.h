#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/realtime/servo_loop.h"
#include "core/record/rows/live_figures.h"
#include "experiments/control/session_control.h"
#include "experiments/runner/devices.h"
#include "protocols/interface/protocol.h"
#include "protocols/tutoring/linked_trials.h"
#include "protocols/tutoring/model_motion.h"

namespace haptrial::experiments {

/// One participant's session: the unit of work. What it records is a pure function of definition,
/// subject and seed on a simulated clock.
struct SessionRequest {
  const protocols::Protocol* protocol{nullptr};
  const protocols::Definition* definition{nullptr};  // of the protocol
  /// Figures while the session runs; empty: it has none. @param resumed  file of the earlier run,
  /// empty without one
  std::function<std::unique_ptr<record::LiveFigures>(const std::filesystem::path& resumed)> live;
  std::string subject;    // identifier, such as "S01"
  int participant{0};     // from 0; chooses the order of conditions
  int session{1};         // of the participant, from 1 to those of the definition
  std::uint64_t seed{0};  // of the study
  realtime::ClockKind clock{realtime::ClockKind::kSimulated};
  std::filesystem::path file;
  std::filesystem::path definition_folder;  // of the pictures of pages
  int frames_per_pass{0};                   // pictures of what was shown, into frames_folder
  std::filesystem::path frames_folder;
  std::optional<protocols::TutorChoice> tutor;  // a recorded run that leads the hand
  std::optional<protocols::LinkChoice> link;    // to a partner's session
  int max_trials{0};                            // of the study proper; 0: all
  std::atomic<std::uint64_t>* ticks{nullptr};   // counts what is done, for a progress line
  const std::atomic<bool>* cancel{nullptr};  // set from outside to end early, as an interrupt does

  // Sessions on the real clock.
  DeviceChoice device;
  std::vector<DeviceChoice> more_devices;       // after the first; empty: as the first
  SessionControl* control{nullptr};             // of an experimenter at a console or keyboard
  protocols::AuxiliaryPages auxiliary_pages{};  // of the protocol's, those that are served
  bool window{false};                           // the participant's screen
  bool stream{false};                           // to the Lab Streaming Layer
  bool stream_optional{false};                  // go on without where the layer is absent
  bool resume{false};                           // go on with FILE.partial where there is one
  bool pilot{false};                            // no part of the study
  /// Lines for whoever watches the terminal, while the session runs; from the session's thread.
  std::function<void(const std::string&)> tell;
  record::Participant person;
};

struct SessionSummary {
  std::uint64_t ticks{0};
  int passes{0};  // in this run
  int aborted_passes{0};
  std::uint64_t overruns{0};
  std::uint64_t dropped{0};
  bool simulated{false};  // the device
  bool stopped{false};    // trials are left, and --resume goes on with them
  bool given_up{false};   // trials are left, since too many were never completed
  std::vector<record::LiveState>
      figures;                       // of the trials of this run; on the real clock, or attended
  std::vector<std::string> notices;  // sentences: real time, screen, streams
  std::vector<std::string> markers;  // how soon they went, a line each way
};

}  // namespace haptrial::experiments
