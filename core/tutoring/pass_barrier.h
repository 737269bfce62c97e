#pragma once

#include <cstdint>

#include "core/tutoring/tick_message.h"

namespace haptrial::tutoring {

/// Keeps the passes of two sessions in step over a link that may lose any message: a pass begins
/// when both sides have come to it, and is completed when both have completed it; one that is
/// aborted on one side is aborted on both. Both present the same items in the same order. A side
/// that finds itself at another item than the other one aborts its pass: it skips a trial that the
/// other has left, and presents again what the other presents again. Servo thread.
class PassBarrier {
 public:
  static constexpr std::uint32_t kPhases = 16;  // of a trial at most

  /// Action of a side at a tick.
  enum class Step : std::uint8_t {
    kWait,      // the other side is not there yet
    kRun,       //
    kHold,      // completed here, but not there
    kComplete,  // on both sides
    kAgain,     // abort: the trial is presented again
    kSkip,      // abort: the other side has left the trial
    kBreak,     // abort: as the other side did
  };

  /// A pass. @param item  kPhases for each trial in their order, and the phase
  void begin(std::uint32_t item) noexcept;
  /// Each tick of a pass. @param own_done  whether the own part is completed
  /// @param alone  the other side is over or closed: nobody is waited for
  Step step(const TurnState& other, bool own_done, bool alone) noexcept;
  /// The pass is aborted, for a reason of this side.
  void abort() noexcept;
  /// A pass has begun and is neither completed on both sides nor aborted.
  bool open() const noexcept { return open_; }
  /// Whether both sides run the pass.
  bool together() const noexcept { return open_ && own_.phase == TurnPhase::kRuns && !alone_; }

  const TurnState& own() const noexcept { return own_; }

 private:
  Step wait(const TurnState& other, bool alone) noexcept;
  Step end(bool completed, Step step) noexcept;
  bool other_has_left(const TurnState& other) const noexcept;

  TurnState own_;
  bool open_{false};
  bool alone_{false};
};

}  // namespace haptrial::tutoring
