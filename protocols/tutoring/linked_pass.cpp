#include "protocols/tutoring/linked_pass.h"

namespace haptrial::protocols {

using tutoring::PassBarrier;

bool LinkedPass::may_begin() noexcept {
  if (!awaited_) {
    awaited_ = true;
    hand_->await(item_);
  }
  return hand_->decided();
}

void LinkedPass::begin(std::uint64_t sequence) noexcept {
  may_begin();  // it may not have been asked
  hand_->begin_pass();
  inner_->begin(sequence);
}

/// Holds the last view, without force.
PassOutput LinkedPass::hold(const Readings& readings) const noexcept {
  PassOutput out = last_;
  static_cast<Drive&>(out) = {};
  out.stage = record::Stage::kIdle;
  out.onsets = {};
  out.shown.tool = readings[0].tool.position;
  return out;
}

/// A world that both work on is compared before the pass is over.
bool LinkedPass::own_done() const noexcept {
  return inner_->state() == PassState::kCompleted &&
         (world_ == nullptr || world_->settled() || hand_->alone());
}

PassOutput LinkedPass::tick(const Readings& readings, double dt) noexcept {
  const bool done = inner_->state() == PassState::kCompleted;
  const PassBarrier::Step step = hand_->begin_tick(own_done(), holds_);
  ticked_ = !done && state_ == PassState::kRunning;
  if (ticked_) {  // also on the tick with which it is aborted: the file has that tick
    last_ = inner_->tick(readings, dt);
  }
  PassOutput out = ticked_ ? last_ : hold(readings);
  if (step == PassBarrier::Step::kComplete) {
    state_ = PassState::kCompleted;
  } else if (step == PassBarrier::Step::kAgain || step == PassBarrier::Step::kSkip ||
             step == PassBarrier::Step::kBreak) {
    state_ = PassState::kAborted;
    why_ = step;
  } else if (inner_->state() == PassState::kAborted) {
    state_ = PassState::kAborted;
    hand_->abort();
  }
  hand_->couple(out, readings[0], dt);
  return out;
}

std::span<const Drive> LinkedPass::others() const noexcept {
  return ticked_ ? inner_->others() : std::span<const Drive>{};
}

bool LinkedPass::wants_attention() noexcept {
  return inner_->wants_attention() || (world_ != nullptr && world_->wants_attention()) ||
         hand_->waiting_rows() > hand_->room() / 2;
}

}  // namespace haptrial::protocols
