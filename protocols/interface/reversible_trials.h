#pragma once

#include <optional>

#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// Trials that can go back to the one before. Session's thread.
class ReversibleTrials {
 public:
  virtual ~ReversibleTrials() = default;

  /// Whether outcomes can be taken back: those that have gone to another program cannot.
  virtual bool can_take_back() const = 0;
  /// Forgets the outcome that Trials::next() was given last: procedures stand as if it had not
  /// been. @returns its trial, which is presented again; nothing if there was none
  virtual std::optional<PlannedTrial> take_back() = 0;
};

}  // namespace haptrial::protocols
