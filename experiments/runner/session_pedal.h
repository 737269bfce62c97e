#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/device/pedal.h"
#include "experiments/runner/devices.h"
#include "experiments/runner/input_losses.h"

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
