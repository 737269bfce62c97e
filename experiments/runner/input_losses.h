#pragma once

#include <string>
#include <vector>

#include "core/device/input_reader.h"

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

}  // namespace haptrial::experiments
