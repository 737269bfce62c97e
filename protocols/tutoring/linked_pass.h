#pragma once

#include "protocols/interface/pass.h"
#include "protocols/interface/shared_simulation.h"
#include "protocols/tutoring/linked_hand.h"

namespace haptrial::protocols {

/// A pass that two sessions have at the same time, whose first device's hands feel each other while
/// both run it.
class LinkedPass final : public Pass {
 public:
  /// @param item   as tutoring::PassBarrier has it
  /// @param holds  whether it lasts until the other side has completed it too
  /// @param world  that both work on; null: there is none
  /// Inner pass, hand and world outlive it.
  LinkedPass(Pass& inner, LinkedHand& hand, std::uint32_t item, bool holds,
             const SharedSimulation* world = nullptr) noexcept
      : inner_(&inner), hand_(&hand), item_(item), holds_(holds), world_(world) {}

  bool may_begin() noexcept override;
  void begin(std::uint64_t sequence) noexcept override;
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  std::span<const Drive> others() const noexcept override;
  void note_suspension() noexcept override { inner_->note_suspension(); }
  PassState state() const noexcept override { return state_; }
  bool names_onsets() const noexcept override { return inner_->names_onsets(); }
  bool wants_attention() noexcept override;

  /// Why it was aborted, if it was; kRun: for a reason of this side.
  tutoring::PassBarrier::Step why() const noexcept { return why_; }

 private:
  bool own_done() const noexcept;
  PassOutput hold(const Readings& readings) const noexcept;

  Pass* inner_;
  LinkedHand* hand_;
  std::uint32_t item_;
  bool holds_;
  const SharedSimulation* world_;
  bool awaited_{false};
  bool ticked_{false};  // the inner pass, in this tick
  PassState state_{PassState::kRunning};
  tutoring::PassBarrier::Step why_{tutoring::PassBarrier::Step::kRun};
  PassOutput last_;  // of the inner pass
};

}  // namespace haptrial::protocols
