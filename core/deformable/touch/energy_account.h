#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace haptrial::deformable {

/// Keeps a sampled touch from giving out more energy than it was given. A force is held from one
/// tick to the next, while the hand moves on: what the hand did against it is known one tick later.
///
///     balance += -f · Δx + b |Δx|² / T
///
/// with b of the damping that every hand on a device has at least. A force that could take more
/// than the balance and a loan on the next way, twice as long as the last ones, is scaled down:
///
///     2 |f| w <= balance + loan,   w = max(|Δx|, 0.9 w)
///
/// So in a contact a hand gets no more than it gave, but for the loan, as long as a way is at most
/// twice as long as those before.
/// After: Hannaford and Ryu 2002, Time-domain passivity control of haptic interfaces; Colgate and
/// Schenkel 1997 (b). Servo thread.
class EnergyAccount {
 public:
  static constexpr double kLoan = 1e-5;    // [J]; a spring of 500 N/m that is bent by 0.2 mm
  static constexpr double kDamping = 0.5;  // b [N·s/m]

  /// Clears the account when there is no contact.
  void open() noexcept { balance_ = 0.0; }

  /// @param force  that was held on the hand since the tick before [N]
  /// @param way  of the hand since then [m]  @param period  T > 0 [s]
  void book(const Eigen::Vector3d& force, const Eigen::Vector3d& way, double period) noexcept {
    way_ = std::max(way.norm(), kForget * way_);
    balance_ += kDamping * way.squaredNorm() / period - force.dot(way);
  }

  /// The share of a force of this size that may be held until the next tick.
  double share(double force) const noexcept {
    const double worst = kAhead * force * way_;
    const double most = balance_ + kLoan;
    return worst <= most ? 1.0 : most > 0.0 ? most / worst : 0.0;
  }

  double balance() const noexcept { return balance_; }  // [J]

 private:
  static constexpr double kAhead = 2.0;
  static constexpr double kForget = 0.9;

  double balance_{0.0};
  double way_{0.0};  // w [m]
};

}  // namespace haptrial::deformable
