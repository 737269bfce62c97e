#pragma once

#include <Eigen/Core>

namespace haptrial::tutoring {

struct TankParameters {
  double wanted{0.05};       // level that the hand's own motion refills >= 0 [J]
  double share{0.02};        // of the level that goes to the partner each tick, 0 to 1
  double refill{100.0};      // damping for each joule that is missing >= 0 [N·s/m / J]
  double most_damping{5.0};  // [N·s/m]
  double least_mass{0.1};    // of handle and hand, as a force meets it within a tick > 0 [kg]
};

/// Keeps one side of a coupling over a network passive, whatever the network does: the hand gets no
/// more energy than hands have given. What the hand gives flows into a tank, what it gets out of
/// it; a share of the level goes to the partner each tick. The energy sent is told as a total, so
/// that a message that is lost, late, doubled or overtaken can lose energy on the way for a while,
/// and never make any.
///
/// The observer is exact: over a tick the device holds f and the hand moves by dp, so it got f dp.
/// The controller scales the force so that the next tick, f v dt + f² dt² / 2 m, gets no more than
/// there is; what the hand's own acceleration a took beyond it, |f| |a| dt², is taken back by
/// damping. Two layers after Franken, Stramigioli, Misra, Secchi and Macchelli (2011); the observer
/// after Hannaford and Ryu (2002).
///
/// Servo thread: no allocation, lock, I/O or throw.
class EnergyTank {
 public:
  explicit EnergyTank(const TankParameters& parameters = {}) noexcept : p_(parameters) {}

  /// One tick.
  /// @param wanted    of the coupling on the hand, in W [N]
  /// @param moved     by the tool since the tick before, in W [m]
  /// @param velocity  of the tool, in W [m/s]
  /// @param received  in all from the partner, the highest total heard of [J]
  /// @param share     of the damping that refills the tank, 0 to 1: while the coupling ramps in
  /// @returns the force that may act until the next tick; zero where an input is not finite.
  Eigen::Vector3d limit(const Eigen::Vector3d& wanted, const Eigen::Vector3d& moved,
                        const Eigen::Vector3d& velocity, double received, double dt,
                        double share = 1.0) noexcept;
  /// A tick at which no force may act. Parameters as those of limit().
  void let_go(const Eigen::Vector3d& moved, double received) noexcept;
  /// Sets the force that acts until the next tick, if something after limit() changed it.
  void acts(const Eigen::Vector3d& force) noexcept { force_ = force; }

  double level() const noexcept { return level_; }  // [J]; below 0 for a tick or a few
  double sent() const noexcept { return sent_; }    // in all to the partner [J]
  double given() const noexcept { return given_; }  // in all to the hand, less what it gave [J]
  double cut() const noexcept { return cut_; }      // force that was cut in the last tick [N]

 private:
  void account(const Eigen::Vector3d& moved, double received) noexcept;
  double damping() const noexcept;

  TankParameters p_;
  Eigen::Vector3d force_{Eigen::Vector3d::Zero()};  // that acts since the last tick
  double level_{0.0};
  double received_{0.0};
  double sent_{0.0};
  double given_{0.0};
  double cut_{0.0};
};

}  // namespace haptrial::tutoring
