#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "core/device/gamepad.h"
#include "experiments/runner/page_keys.h"
#include "experiments/runner/reported_mistakes.h"
#include "experiments/runner/session_pedal.h"
#include "protocols/interface/window_input.h"

namespace haptrial::experiments {

/// Takes what a participant says beside moving the handle: by keys of the window, a pedal, and the
/// buttons of a game controller. The screen's thread writes what its keys say; all else is the
/// session's thread.
class ParticipantInput {
 public:
  /// @param device  the session's first one
  /// @param report  called for each trial whose answer is said to be a mistake
  /// @throws InputError as SessionPedal does
  ParticipantInput(const DeviceChoice& device, const protocols::Definition& definition, bool real,
                   std::function<void(const std::string& trial)> report)
      : pedal(device, definition, real), mistakes(std::move(report)) {}

  /// News of pedal and game controller since the last call. @param pad  null: there is none
  std::vector<InputNews> take_news(device::Gamepad* pad);
  /// Sentences for the end: how often each was lost.
  std::vector<std::string> losses(device::Gamepad* pad) const;

  SessionPedal pedal;
  protocols::WindowInput window;           // for a trial
  std::atomic<bool> begin_pressed{false};  // without an experimenter
  PageKeys page_keys;
  ReportedMistakes mistakes;

 private:
  InputLosses pad_losses_{"gamepad", "game controller", "is at rest"};
};

}  // namespace haptrial::experiments
