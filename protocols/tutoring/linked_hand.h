#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

#include "core/realtime/block_log.h"
#include "core/realtime/latest_value.h"
#include "core/record/rows/partner_rows.h"
#include "core/stimulus/observer.h"
#include "core/tutoring/coupled_side.h"
#include "core/tutoring/pass_barrier.h"
#include "core/tutoring/reliable_stream.h"
#include "core/tutoring/sequence_window.h"
#include "core/tutoring/tutoring_law.h"
#include "core/tutoring/wire.h"
#include "protocols/definition/tutoring_options.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {

/// How well messages come through. Servo thread.
class LinkQuality {
 public:
  void hear(const tutoring::Arrived& arrived) noexcept;
  /// Takes a tick's counts; call once a tick. @param window  of the messages
  void step(const tutoring::SequenceWindow& window, std::int64_t now_ns) noexcept;

  /// Mean change of the time under way from message to message (RFC 3550, 6.4.1) [s].
  double jitter() const noexcept { return jitter_; }
  double loss() const noexcept { return loss_; }  // share of the last second's messages

 private:
  std::int64_t transit_{0};  // of the message before, up to the clocks' offset [ns]
  bool begun_{false};
  double jitter_{0.0};
  std::int64_t second_ends_{0};
  std::uint64_t highest_{0};  // at the beginning of the second
  std::uint64_t accepted_{0};
  double loss_{0.0};
};

/// Role of a side in the beginning: its hand leads or is led.
enum class LinkRole : std::uint8_t { kTeaches, kLearns };

/// The first device's hand, coupled to a partner's over a wire: what is heard, felt and told at
/// each tick of a session, in passes and between them. Servo thread, unless a function says
/// otherwise: no allocation, lock, I/O or throw; on a real clock nothing waits.
class LinkedHand final : public TickLog, public stimulus::Observer, private tutoring::Listener {
 public:
  struct Parts {
    const TutoringOptions& options;
    LinkRole role{LinkRole::kLearns};
    tutoring::Wire& wire;
    TickLog* inner{nullptr};                      // the protocol's own; null: none
    std::function<void()> stop;                   // an emergency stop of the own session
    tutoring::ReliablePayload* payload{nullptr};  // that must not be lost; null: there is none
  };
  /// All parts outlive it.
  explicit LinkedHand(const Parts& parts);

  // One pass, in this order.
  /// @param item  as PassBarrier has it
  void await(std::uint32_t item) noexcept;
  bool decided() const noexcept;  // whether the pass may begin, or is to be aborted
  void begin_pass() noexcept { begun_ = true; }
  /// A tick of the pass, first of all. @param own_done  whether the own part is completed
  /// @param holds  whether the pass then lasts until the other side has completed it too
  tutoring::PassBarrier::Step begin_tick(bool own_done, bool holds) noexcept;
  /// The same tick: what the hand feels of both worlds. @param out  of the own world; changed
  void couple(PassOutput& out, const device::DeviceReading& reading, double dt) noexcept;
  /// Whether nothing is to be expected of the partner any more.
  bool alone() const noexcept { return ever_over_ || p_.wire.closed(); }
  /// The own part was aborted.
  void abort() noexcept { turns_.abort(); }

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;
  void record(std::uint64_t sequence, const Readings& readings,
              device::Fault fault) noexcept override;

  /// Takes the lead of both hands, or hands it over; else it is as the definition says. Any thread.
  void take_lead(bool take) noexcept { lead_asked_.store(take ? 1 : 0, std::memory_order_relaxed); }
  /// Whether the partner has stopped this side since the last await(). Any thread.
  bool stopped_by_partner() const noexcept {
    return stopped_by_partner_.load(std::memory_order_relaxed);
  }
  /// Session's thread.
  const record::PartnerState& state() noexcept;
  template <class F>
  void flush(F&& f) {
    log_.flush(std::forward<F>(f));
  }
  std::uint64_t dropped() const noexcept { return log_.dropped(); }
  /// Servo thread.
  std::size_t waiting_rows() const noexcept { return log_.taken(); }
  std::size_t room() const noexcept { return log_.capacity(); }
  /// Last message to the partner when the loop has ended. @param flag  kOver or kLeft
  tutoring::TickMessage last_words(tutoring::TickFlag flag) const noexcept;

 private:
  void hear(const tutoring::Arrived& arrived) noexcept override;
  void listen() noexcept;
  void heed_partner() noexcept;
  double keep_within_envelope(PassOutput& out) noexcept;
  bool claims() const noexcept { return lead_asked_.load(std::memory_order_relaxed) == 1; }
  void share_lead(bool engaged, double dt) noexcept;
  void step(const PointState& tool, const Eigen::Vector3d& own_force,
            const Eigen::Vector3d& own_stimulus, std::uint32_t buttons, double dt) noexcept;
  void tell_state(double dt) noexcept;
  std::uint32_t flags() const noexcept;
  void keep_row(std::uint64_t sequence) noexcept;

  Parts p_;
  tutoring::CoupledSide side_;
  std::unique_ptr<tutoring::ReliableStream> stream_;  // where there is payload
  tutoring::PassBarrier turns_;
  tutoring::PassBarrier::Step step_{tutoring::PassBarrier::Step::kWait};  // the last one
  LinkQuality quality_;
  tutoring::Handover coupled_;  // how much of the coupling is on
  tutoring::Handover claim_;    // of the lead, by this side
  tutoring::Handover taught_;   // authority of who teaches, at that side
  realtime::BlockLog<record::LinkRow> log_{1024, 16};
  realtime::LatestValue<record::PartnerState> told_;
  record::PartnerState read_;  // session's thread
  std::atomic<bool> stopped_by_partner_{false};
  std::atomic<int> lead_asked_{-1};  // 1: to be taken, 0: to be handed over, -1: neither

  std::int64_t now_{0};        // own clock at this tick [ns]
  std::int64_t first_now_{0};  // at the first
  bool listened_{false};       // in this tick
  bool begun_{false};          // the pass that waited has begun
  bool runs_{false};           // the own pass is in its run
  bool stop_seen_{false};      // the partner's stop is known
  bool ever_over_{false};      // the partner has said that it is over
  bool ever_left_{false};
  device::Fault fault_{device::Fault::kNone};
  tutoring::CoupledSide::OwnState own_;
  Eigen::Vector3d coupling_{Eigen::Vector3d::Zero()};  // of this tick, before the envelope [N]
  Eigen::Vector3d acts_{Eigen::Vector3d::Zero()};      // on the hand until the next tick [N]
  double last_share_{1.0};                             // of the own world
  double dt_{1e-3};
  std::int32_t arrived_{0};
  std::int64_t sent_{0};  // number of this tick's message
  double untold_{0.0};    // since the state was told [s]
};

}  // namespace haptrial::protocols
