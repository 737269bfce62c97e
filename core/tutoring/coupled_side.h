#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/tutoring/clock_offset.h"
#include "core/tutoring/deadband.h"
#include "core/tutoring/energy_tank.h"
#include "core/tutoring/jitter_buffer.h"
#include "core/tutoring/sequence_window.h"
#include "core/tutoring/tick_message.h"
#include "core/tutoring/tutoring_law.h"

namespace haptrial::tutoring {

/// Method that keeps a coupling over a delay from swinging up.
enum class Passivity : std::uint8_t {
  kNone,  // nothing: right where only one side feels the other
  kTank,  // tutoring::EnergyTank
};

struct SideParameters {
  tutoring::TutoringGains gains;
  Passivity passivity{Passivity::kTank};
  tutoring::TankParameters tank;
  bool sparse{false};  // only the messages that Deadband asks for
  tutoring::DeadbandParameters deadband;
  bool even{false};            // partner's ticks as evenly as they were sent; costs delay
  double late{0.01};           // share of messages that may be too late for that
  double longest_buffer{0.1};  // [s]
  double deadline{0.1};        // silence after which the link counts as lost > 0 [s]
  double ramp{0.5};            // from no force to all of it, also after a loss > 0 [s]
};

/// One side of a coupling over a link: what it hears, what it feels, what it tells. The same on a
/// simulated and on a real link. What keeps it passive watches spring and damper; the forces of the
/// partner's world are played as those of the own one would be, which works on a hand by intent.
/// Servo thread: no allocation, lock, I/O or throw after the
/// constructor.
class CoupledSide {
 public:
  /// @param start  of the own tool, in W [m]
  explicit CoupledSide(const SideParameters& parameters,
                       const Eigen::Vector3d& start = Eigen::Vector3d::Zero());

  /// A message that has arrived; one that came before is dropped. @param now_ns  own clock
  void hear(const TickMessage& message, std::int64_t now_ns) noexcept;

  struct OwnState {
    PointState tool;                                    // in W
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};     // of the own world on the tool, in W [N]
    Eigen::Vector3d stimulus{Eigen::Vector3d::Zero()};  // of that force (ForceIntent::stimulus) [N]
    double lead{0.0};                                   // own authority, 0 to 1
    double felt_back{0.0};                              // of the coupling, where this side leads
    std::uint32_t buttons{0};
    std::uint32_t flags{0};
    std::uint64_t world{0};
    TurnState turn;
    bool news{false};  // something else is to go with a message
  };
  struct Output {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the own tool, in W [N]
    std::optional<TickMessage> message;              // to send
  };
  /// A tick, after hear() of the messages that arrived before it. When the link is lost, the
  /// partner's force falls to zero within 50 ms, as the own world comes back.
  Output step(const OwnState& own, std::int64_t now_ns, double dt) noexcept;

  /// Sets the force of the partner's world and the coupling that acts until the next tick, if
  /// something after step() changed it.
  void acts(const Eigen::Vector3d& force) noexcept { tank_.acts(force - played_); }

  /// The part of the force that is a stimulus of the partner's world [N].
  const Eigen::Vector3d& played_stimulus() const noexcept { return played_stimulus_; }

  /// How much of the own world the hand feels, 0 to 1: the own lead where there is a link. A hand
  /// that its partner has left has nothing else to rest on, so that the own world is back within 50
  /// ms, and goes as the partner's comes.
  double own_share() const noexcept { return own_share_; }
  /// Whether the partner was heard within the deadline.
  bool linked() const noexcept { return linked_; }
  std::uint64_t losses() const noexcept { return losses_; }               // of the link
  const tutoring::Partner& partner() const noexcept { return partner_; }  // as this side takes it
  const TickMessage& newest() const noexcept { return newest_; }
  std::int64_t heard_ns() const noexcept { return heard_ns_; }  // own clock, when that came
  /// The message that this tick goes by; its number is 0 before the first.
  const TickMessage& used() const noexcept { return used_; }
  double energy_heard() const noexcept { return energy_heard_; }  // from the partner in all [J]
  const SequenceWindow& sequence() const noexcept { return window_; }
  const ClockOffset& clock() const noexcept { return clock_; }
  const JitterBuffer& buffer() const noexcept { return *buffer_; }
  const tutoring::EnergyTank& tank() const noexcept { return tank_; }
  std::uint64_t messages() const noexcept { return sent_; }

 private:
  void look_at_link(std::int64_t now_ns, double dt) noexcept;
  void look_at_partner(std::int64_t now_ns, double dt) noexcept;
  Eigen::Vector3d felt(const OwnState& own, double dt) noexcept;
  std::optional<TickMessage> told(const OwnState& own, std::int64_t now_ns, double dt) noexcept;
  bool due(const OwnState& own, double dt) noexcept;

  SideParameters p_;
  SequenceWindow window_;
  ClockOffset clock_;
  std::unique_ptr<JitterBuffer> buffer_;  // large
  tutoring::EnergyTank tank_;
  tutoring::Deadband deadband_;

  TickMessage newest_;        // by sequence number
  TickMessage used_;          // that the partner's state is from
  double used_for_{0.0};      // [s]
  std::int64_t heard_ns_{0};  // when the newest came
  double energy_heard_{0.0};  // highest total
  tutoring::Partner partner_;
  tutoring::Partner behind_;    // difference of partner_ from what came, when ticks were skipped
  double catch_up_{0.0};        // time over which it fades: as long as was skipped, up to 50 ms [s]
  double catching_up_{0.0};     // the rest of that time [s]
  Eigen::Vector3d last_place_;  // of the own tool
  Eigen::Vector3d played_{Eigen::Vector3d::Zero()};  // of the partner's world, in this tick [N]
  Eigen::Vector3d played_stimulus_{Eigen::Vector3d::Zero()};  // of that [N]
  bool stepped_{false};
  bool linked_{false};
  double strength_{0.0};  // of the ramp, 0 to 1
  double stead_{1.0};     // of the own world, for what the partner's does not do, 0 to 1
  double own_share_{1.0};
  std::uint64_t losses_{0};
  std::uint64_t sent_{0};
  std::uint32_t told_flags_{0};
  TurnState told_turn_;
};

}  // namespace haptrial::tutoring
