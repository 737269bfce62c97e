#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "core/bone/simulator/simulator.h"
#include "protocols/bone_drilling/bone_parcels.h"
#include "protocols/interface/shared_simulation.h"

namespace haptrial::protocols {

/// A bone that two linked sessions have: it belongs to the side that leads, and the other side's
/// follows it tick by tick, bit for bit. With each tick goes a witness of all that was done to the
/// bone, and at the end of a pass both sides compare checksums.
/// docs/decisions/0013-led-bone-by-ticks.md.
class SharedBone final : public SharedSimulation {
 public:
  explicit SharedBone(bool leads);
  bool leads() const noexcept { return leads_; }

  // Session's thread, while no pass runs. ---------------------------------------------------------

  /// @param checksum  of the bone that is drilled from now on
  void take_new_bone(std::uint64_t checksum) noexcept;
  /// Whether the other side drills a newer one than this.
  bool needs_new_bone() const noexcept { return needs_new_bone_.load(std::memory_order_relaxed); }
  void prepare_pass(std::int32_t trial) noexcept;
  /// Comparison of both sides' bones once the pass is completed and until it is settled: the
  /// checksum, which takes a while.
  /// @returns a sentence where there is something to say, and whether it is of a difference
  struct BoneComparison {
    bool differs{false};
    std::string text;
  };
  std::optional<BoneComparison> attend(const bone::Simulator& simulator);

  // Servo thread: no allocation, lock, I/O or throw. ----------------------------------------------

  // The side that leads.
  void tell_begin() noexcept;
  /// Tells a step; call after the tick. @param recorded  that it was of
  void tell_step(const device::DeviceReading& recorded, const bone::Simulator& simulator) noexcept;
  void tell_end() noexcept;

  // The side that follows.
  BoneParcels& inbox() noexcept { return inbox_; }
  /// Whether the next step was done by a pass that ended before it was told of it. Also the
  /// session's thread, while no pass runs.
  bool step_is_done() const noexcept { return step_is_done_; }
  void set_step_is_done(bool done) noexcept { step_is_done_ = done; }
  /// A kBegin is next. @returns false where it is of a newer bone than the one that follows: the
  /// pass has to be aborted, and another bone to be taken.
  bool reach(const BoneBegin& begin) noexcept;
  std::int32_t reached_trial() const noexcept { return reached_.trial; }
  /// Notes a tick that was told and has been followed. @returns its number, from 1 when the bone
  /// was new
  std::uint64_t followed(const BoneStep& step, const bone::Simulator& simulator) noexcept;
  void reach_end() noexcept { completed_.store(true, std::memory_order_release); }
  /// A later pass of the other side has begun than the one that was reached.
  bool superseded() const noexcept { return newest_pass_ > reached_.pass; }

  std::size_t give(std::span<std::byte> room) noexcept override;
  void take(std::span<const std::byte> bytes) noexcept override;
  bool settled() const noexcept override { return told_.load(std::memory_order_acquire); }
  bool wants_attention() const noexcept override;

 private:
  void put(const BoneParcel& parcel) noexcept;
  void accept(const BoneParcel& parcel) noexcept;
  std::optional<BoneComparison> difference() noexcept;

  bool leads_;
  BoneParcels outbox_;
  BoneParcels inbox_;
  std::int32_t trial_{0};
  std::int32_t bone_{0};  // the other side's count where it leads; 0: none was followed yet
  std::uint64_t new_bone_{0};
  std::uint64_t witness_{0};
  std::int32_t pass_{0};         // the one that leads: its passes so far
  std::int32_t newest_pass_{0};  // the one that follows: of the last kBegin that came
  BoneBegin reached_;
  bool sum_given_{false};
  bool step_is_done_{false};

  std::atomic<std::uint64_t> steps_{0};       // of the bone
  std::atomic<std::uint64_t> differs_at_{0};  // step with the first difference; 0: none
  std::atomic<bool> new_differs_{false};      // the bone was another from the beginning
  std::atomic<bool> needs_new_bone_{false};
  std::atomic<bool> no_room_{false};    // for what the other side had to be told
  std::atomic<bool> completed_{false};  // the pass
  std::atomic<bool> own_known_{false};
  std::atomic<bool> their_known_{false};
  std::atomic<bool> told_{false};  // what came of the comparison
  std::atomic<std::uint64_t> own_sum_{0};
  std::atomic<std::uint64_t> their_sum_{0};
  bool difference_told_{false};  // session's thread
};

}  // namespace haptrial::protocols
