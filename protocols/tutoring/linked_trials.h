#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/tutoring/wire.h"
#include "protocols/definition/tutoring_options.h"
#include "protocols/interface/pass.h"
#include "protocols/interface/shared_simulation.h"
#include "protocols/interface/trials.h"
#include "protocols/tutoring/linked_hand.h"

namespace haptrial::protocols {

/// Which side of a pair of sessions this one is, and how it reaches the other.
struct LinkChoice {
  LinkRole role{LinkRole::kLearns};
  std::shared_ptr<tutoring::Wire> wire;
  std::string session;  // of the link, the same on both sides; never the secret
};

/// "teaches" or "learns": for the session's event "tutor".
const char* name_of(LinkRole role) noexcept;

/// Trials of any protocol in step with those of another session, pass by pass, the first device's
/// hands coupled by the law of tutoring (source: Morris 2006, §3.4.1). What the link does is
/// recorded in /link, tick by tick. The session ends, to be resumed, where the other one does or is
/// not heard any more.
/// @param place  of the session; outlives the trials
std::unique_ptr<Trials> linked(std::unique_ptr<Trials> trials, const TutoringOptions& options,
                               const LinkChoice& link, const SessionPlace& place);

/// Which of several networks a trial goes over: every one once in each run of as many trials, in an
/// order that is drawn for it.
/// @param trial  from 0, practice included  @param count  > 0  @param seed  of the session
std::size_t network_of_trial(std::size_t trial, std::size_t count, std::uint64_t seed);

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
