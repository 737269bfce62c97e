#include "core/tutoring/pass_barrier.h"

namespace haptrial::tutoring {

static std::uint32_t trial_of(std::uint32_t item) { return item / PassBarrier::kPhases; }

void PassBarrier::begin(std::uint32_t item) noexcept {
  own_.last_done = own_.phase == TurnPhase::kDone ? 1 : 0;
  ++own_.pass;
  own_.with = 0;
  own_.item = item;
  own_.phase = TurnPhase::kReady;
  open_ = true;
  alone_ = false;
}

PassBarrier::Step PassBarrier::end(bool completed, Step step) noexcept {
  own_.phase = completed ? TurnPhase::kDone : TurnPhase::kBroken;
  open_ = false;
  return step;
}

void PassBarrier::abort() noexcept {
  if (open_) {
    end(false, Step::kBreak);
  }
}

/// Only a side that waits says where it is for certain: what else it says may be of the pass
/// before.
PassBarrier::Step PassBarrier::wait(const TurnState& other, bool alone) noexcept {
  const bool ready = other.phase == TurnPhase::kReady;
  const bool begun = other.phase == TurnPhase::kRuns || other.phase == TurnPhase::kDone;
  if (alone || (other.item == own_.item && (ready || (begun && other.with == own_.pass)))) {
    own_.with = other.pass;
    own_.phase = TurnPhase::kRuns;
    alone_ = alone;
    return Step::kRun;
  }
  if (ready && trial_of(other.item) > trial_of(own_.item)) {
    return end(false, Step::kSkip);
  }
  if (ready && trial_of(other.item) == trial_of(own_.item) && other.item < own_.item) {
    return end(false, Step::kAgain);
  }
  return Step::kWait;
}

/// Whether the other side has begun a later pass than the one that goes with the own.
bool PassBarrier::other_has_left(const TurnState& other) const noexcept {
  return other.pass > own_.with;
}

PassBarrier::Step PassBarrier::step(const TurnState& other, bool own_done, bool alone) noexcept {
  if (own_.phase == TurnPhase::kReady) {
    return wait(other, alone);
  }
  alone_ = alone_ || alone;
  const bool left = other_has_left(other);
  const bool theirs = other.pass == own_.with;
  const bool broken = (theirs && other.phase == TurnPhase::kBroken) ||
                      (left && (other.pass > own_.with + 1 || other.last_done == 0));
  if (broken && !alone_) {
    return end(false, Step::kBreak);
  }
  if (!own_done) {
    return Step::kRun;
  }
  own_.phase = TurnPhase::kDone;
  const bool done = alone_ || left || (theirs && other.phase == TurnPhase::kDone);
  return done ? end(true, Step::kComplete) : Step::kHold;
}

}  // namespace haptrial::tutoring
