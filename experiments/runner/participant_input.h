#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/device/gamepad.h"
#include "core/device/input_reader.h"
#include "core/device/pedal.h"
#include "experiments/runner/devices.h"
#include "experiments/runner/page_input.h"
#include "experiments/runner/reported_mistakes.h"
#include "protocols/interface/window_input.h"

namespace haptrial::experiments {

/// News of an input device: the event to record, and the sentence for the experimenter.
struct InputNews {
  std::string event;   // "pedal_lost" or "pedal_back"
  std::string text;    // of the event
  std::string notice;  // empty: none
};

/// How often an input device was lost during a session. Session's thread.
class InputLosses {
 public:
  /// @param what       "pedal"; events begin with it
  /// @param name       "pedal"; sentences call it so
  /// @param meanwhile  "counts as up"
  InputLosses(std::string what, std::string name, std::string meanwhile)
      : what_(std::move(what)), name_(std::move(name)), meanwhile_(std::move(meanwhile)) {}

  /// Notes its changes since the last call. @param input  its file
  std::vector<InputNews> take(const std::string& input,
                              const std::vector<device::InputChange>& changes);
  /// Sentence for the end of the session; empty if the device was lost once at most, which take()
  /// has said.
  std::string sentence(const std::string& input) const;

 private:
  std::string what_;
  std::string name_;
  std::string meanwhile_;
  int losses_{0};
};

/// The analog pedal of a session, if a person takes part and the definition has a use for one; and
/// what becomes of it while the session runs. Session's thread.
class SessionPedal {
 public:
  /// @param device  the session's first one: a virtual hand or a recording has no foot
  /// @param real    whether the session is on the real clock
  /// @throws InputError as device::Pedal does, and if the definition has an answer that only a
  /// pedal gives and no table [pedal]
  SessionPedal(const DeviceChoice& device, const protocols::Definition& definition, bool real);

  /// Null: there is none, and readings keep what the device says.
  device::Pedal* pedal() { return pedal_.get(); }
  /// Notice for the beginning: that a pedal would be used, and that none is named. Empty: all is
  /// well.
  const std::string& notice() const { return notice_; }
  /// News since the last call.
  std::vector<InputNews> take_news();
  /// Sentence for the end: how often the pedal was lost; empty if at most once, which take_news()
  /// has said.
  std::string losses() const;

 private:
  std::unique_ptr<device::Pedal> pedal_;
  std::string notice_;
  InputLosses losses_{"pedal", "pedal", "counts as up"};
};

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
