#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"
#include "core/device/device.h"
#include "core/device/fault.h"
#include "core/device/force_watch.h"
#include "core/device/reading_watch.h"

namespace haptrial::device {

/// Bounds that no protocol may leave. A device's own limits apply as well.
struct EnvelopeLimits {
  double max_force{12.0};          // > 0 [N]
  double max_force_rate{4000.0};   // > 0 [N/s]
  double workspace_radius{0.075};  // about the origin > 0 [m]
  double max_speed{1.0};           // > 0 [m/s]
  double max_jump{0.005};          // between two ticks > 0 [m]
  double ramp_in{0.2};             // force grows from zero over this time after a start [s]
  double ramp_out{0.2};            // and falls to zero over this one after release() [s]
  double change_time{0.05};        // from one force to another at go_over() [s]
  double max_saturation{3.0};      // without a break at max_force > 0 [s]
  double holding_force{0.5};  // change of force that friction and a still hand may hide > 0 [N]
};

/// The keys of [envelope], with the bounds that any version recorded.
const Schema<EnvelopeLimits>& envelope_schema();

/// Notes values with which no session may begin. @param table  [envelope]
void check_new_envelope(Table& table, const EnvelopeLimits& limits);

/// Stands between every protocol and every device on every tick. The force that leaves it is
/// finite, never longer than max_force and never changes faster than max_force_rate, except that a
/// fault brings it to zero in the same tick; it then stays zero until reset(). A normal end does
/// not drop the force but lets it go over ramp_out, and where a protocol goes over to other forces
/// the difference fades over change_time.
///
/// Beside each tick's own limits it watches what only many ticks show: readings that freeze or
/// jitter (ReadingWatch; while they are suspicious the force does not grow), a force that swings to
/// and fro or stays at its limit (ForceWatch), and energy that nobody meant to give (EnergyWatch).
/// Servo thread: no allocation, lock, I/O or throw.
class Envelope {
 public:
  /// @throws std::invalid_argument when a limit is not above its bound.
  explicit Envelope(const EnvelopeLimits& limits);

  /// Judges a reading. @param read_ok  what Device::read returned. @returns the fault in force.
  /// Motors that are off are a fault where a force was commanded on the tick before.
  Fault check(bool read_ok, const DeviceReading& reading) noexcept;

  /// @param wanted  the protocol's force [N]; more than max_force is a fault of the protocol, which
  ///                is expected to saturate by itself.
  /// @param dt      since the previous tick [s]
  /// @param intent  of `wanted`
  Eigen::Vector3d limit(const Eigen::Vector3d& wanted, double dt,
                        const ForceIntent& intent = ForceIntent{}) noexcept;

  /// Latches a fault from outside (a failed write, an emergency stop).
  void trip(Fault fault) noexcept;
  /// Clears the fault; the force ramps in again from zero. A person asked for it.
  void reset() noexcept;
  /// A normal end: from its present value the force goes evenly to zero over ramp_out (longer where
  /// max_force_rate says so) whatever limit() is asked for, and stays zero until engage() or
  /// reset(). Releasing again while it falls changes nothing.
  void release() noexcept;
  /// The opposite of release(): the force follows limit() again and ramps in. A fault stays.
  void engage() noexcept;
  /// The protocol goes over to other forces with the next limit(): what changes by that fades over
  /// change_time, and so does a stimulus that ended; one that begins or goes on is left as it is.
  void go_over() noexcept { goes_over_ = true; }
  /// The loop has not run for a while, so the force that it gave last is no longer due: it begins
  /// at zero and ramps in. The next reading may be far from the last.
  void resume() noexcept;

  const EnvelopeLimits& limits() const noexcept { return limits_; }
  Fault fault() const noexcept { return fault_; }
  bool released() const noexcept { return released_; }
  /// Released, and the force has gone.
  bool at_rest() const noexcept { return released_ && last_force_.isZero(0.0); }
  /// The force that limit() let pass last [N].
  const Eigen::Vector3d& force() const noexcept { return last_force_; }

 private:
  Eigen::Vector3d target(const Eigen::Vector3d& wanted, double dt, ForceIntent& intent) noexcept;
  Eigen::Vector3d blend(const Eigen::Vector3d& wanted, double dt) noexcept;
  Eigen::Vector3d approach(const Eigen::Vector3d& goal, double dt) const noexcept;
  void watch_readings(double dt) noexcept;
  void watch_force(const Eigen::Vector3d& force, double dt, const ForceIntent& intent) noexcept;

  EnvelopeLimits limits_;
  Fault fault_{Fault::kNone};
  Eigen::Vector3d last_force_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d last_position_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d last_velocity_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d released_force_{Eigen::Vector3d::Zero()};  // at release()
  bool has_position_{false};
  bool has_watched_{false};
  bool fresh_{false};  // a reading has come since the last limit()
  ReadingWatch readings_;
  ForceWatch forces_;
  EnergyWatch energy_;
  Eigen::Vector3d before_last_force_{Eigen::Vector3d::Zero()};  // it acted until this tick
  ForceIntent last_intent_;                                     // of last_force_
  ForceIntent before_last_intent_;                              // of before_last_force_
  Eigen::Vector3d watched_position_{Eigen::Vector3d::Zero()};   // at the last limit() [m]
  Eigen::Vector3d followed_{Eigen::Vector3d::Zero()};   // before the ramp, without the stimulus [N]
  Eigen::Vector3d left_over_{Eigen::Vector3d::Zero()};  // of the force before go_over() [N]
  double since_change_{0.0};                            // [s]
  bool goes_over_{false};
  double bound_{0.0};  // of the force while readings are suspicious [N]
  bool bounded_{false};
  bool released_{false};
  double since_start_{0.0};    // or engage() [s]
  double since_release_{0.0};  // [s]
};

}  // namespace haptrial::device
