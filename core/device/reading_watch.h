#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/device/fault.h"

namespace haptrial::device {

/// Finds readings that cannot be those of a hand, though each alone could be.
///
/// - Frozen: position and velocity equal those before to the last bit for 20 ms, and the velocity
///   is not zero. Or the position alone stayed the same although the force changed: see in_doubt().
/// - Jitter: eight times within 50 ms the velocity between readings changes by more than a hand and
///   a device can bring about: 500 m/s², but at least 0.1 mm a tick, which covers the resolution of
///   encoders. A knock against a stop is one or two such ticks. A device whose clock is its own
///   gives readings twice and leaves others out: two ticks of the way of the last 16 are left free.
///
/// Servo thread: no allocation, lock, I/O or throw.
class ReadingWatch {
 public:
  /// @param holding_force  change of force that may leave the handle where it is > 0 [N]
  explicit ReadingWatch(double holding_force) : holding_force_(holding_force) {}

  /// @param position, velocity  of this tick [m], [m/s]
  /// @param force     the device was given last [N]
  /// @param dt        since the reading before > 0 [s]
  /// @returns kFrozen, kJitter or kNone.
  Fault look(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
             const Eigen::Vector3d& force, double dt) noexcept;

  /// The position stayed the same although the force changed by more than friction and a still hand
  /// hold against, without turning round as a vibration does, for so long that a free hand of 2 kg
  /// would have moved by 0.06 mm, or by twice the smallest step that was seen. It may be frozen, or
  /// a hand tenses against just this force: the force should now fall. A hand that tenses moves
  /// before it has lost 1.5 N, which ends the doubt; if the position is still the same when the
  /// force has lost as much, or has been gone for a quarter of a second, it is frozen.
  bool in_doubt() const noexcept { return doubted_ > 0.0; }

  /// Something is odd and may become a fault: the force should not grow until this is clear.
  bool suspicious() const noexcept { return odd_for_ > 0.0 || equal_for_ >= kSuspiciousAfter; }

  void reset() noexcept { *this = ReadingWatch(holding_force_); }

 private:
  static constexpr double kSuspiciousAfter = 0.010;  // of equal readings [s]
  static constexpr int kJitterTicks = 8;

  bool frozen(bool equal, const Eigen::Vector3d& force, double dt) noexcept;
  bool stale(bool equal, const Eigen::Vector3d& velocity, double dt) noexcept;
  bool jitters(const Eigen::Vector3d& step, double dt) noexcept;
  double way_in_two_ticks(double dt) noexcept;

  double holding_force_;
  int seen_{0};
  double time_{0.0};  // [s]
  Eigen::Vector3d position_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d step_{Eigen::Vector3d::Zero()};  // between the last two readings [m]
  double smallest_step_{0.0};                      // that is not zero; 0: none was seen [m]
  double equal_for_{0.0};                          // [s]
  Eigen::Vector3d velocity_{Eigen::Vector3d::Zero()};
  double stale_for_{0.0};                                // [s]
  Eigen::Vector3d mean_{Eigen::Vector3d::Zero()};        // of the force, over some 20 ms [N]
  Eigen::Vector3d held_{Eigen::Vector3d::Zero()};        // mean force while the hand moved last [N]
  Eigen::Vector3d free_speed_{Eigen::Vector3d::Zero()};  // of a free hand since then [m/s]
  Eigen::Vector3d free_way_{Eigen::Vector3d::Zero()};    // [m]
  double doubted_{0.0};   // force when the position was first in doubt; 0: it is not [N]
  double gone_for_{0.0};  // since the force has gone in doubt [s]
  double odd_for_{0.0};   // left, after an odd step [s]
  std::array<double, kJitterTicks - 1> odd_at_{};  // ring of times [s]
  int odd_{0};

  struct Place {
    Eigen::Vector3d position{Eigen::Vector3d::Zero()};
    double time{0.0};  // [s]
  };
  std::array<Place, 16> passed_{};  // ring
  std::size_t passes_{0};
  double dt_{0.0};  // of the reading before [s]
};

}  // namespace haptrial::device
