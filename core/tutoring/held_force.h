#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace haptrial::tutoring {

/// Chooses the force that a partner is to hold until the next message: one that stays within a
/// bound of the forces to come for as long as can be expected. The present force is a poor choice
/// where it is at the edge of its own noise, or on its way through a ramp.
///
/// What is to come is taken from what came after the moments of the last 0.1 s (at 1 kHz) at which
/// the force ran as it does now: analogues, as in Lorenz (1969). Of the middles of what they went
/// through in 1, 3, 7 and 15 ticks, and the present force, the one that they would all have stayed
/// near for longest is chosen.
/// Servo thread: no allocation, lock, I/O or throw; a choice costs a few microseconds.
class HeldForce {
 public:
  /// A tick. @param force  [N]
  void add(const Eigen::Vector3d& force) noexcept;
  /// @param most  bound > 0 [N]
  /// @returns a force within the bound of the last one that was added [N]
  Eigen::Vector3d choose(double most) const noexcept;

 private:
  static constexpr std::size_t kHistory = 128;  // ticks; a power of two
  static constexpr std::size_t kAnalogues = 6;
  struct Analogue {
    double difference{0.0};
    std::size_t ago{0};  // [ticks]
  };
  struct Analogues {
    std::array<Analogue, kAnalogues> all{};
    std::size_t count{0};
    void offer(const Analogue& one) noexcept;
  };

  const Eigen::Vector3d& at(std::size_t ago) const noexcept {
    return forces_[(count_ - 1 - ago) % kHistory];
  }
  double difference(std::size_t ago) const noexcept;
  Analogues nearest() const noexcept;
  /// The force in `ticks` ticks if it changes as it did after the tick `ago`.
  Eigen::Vector3d coming(std::size_t ago, std::size_t ticks) const noexcept {
    return at(ago - ticks) + (at(0) - at(ago));
  }
  double lasts(const Eigen::Vector3d& held, const Analogues& analogues, double most) const noexcept;

  std::array<Eigen::Vector3d, kHistory> forces_;
  std::size_t count_{0};
};

}  // namespace haptrial::tutoring
