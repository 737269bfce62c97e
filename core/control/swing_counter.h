#pragma once

#include <Eigen/Core>
#include <array>

namespace haptrial::control {

/// Counts the turning points of a force: a component that goes up and down by at least a given
/// swing, with not too long between two turns, belongs to a train.
///
/// A part of the force may be accounted for, because it alternates by itself (a vibration, a relief
/// under a moving hand). It is taken out, and the least swing grows by the swing of that part,
/// since what answers to it is at most about as large.
///
/// Servo thread: no allocation, lock, I/O or throw.
class SwingCounter {
 public:
  /// @param least_swing  peak to peak > 0 [N]
  /// @param longest_gap  between two turns > 0 [s]
  SwingCounter(double least_swing, double longest_gap) noexcept
      : least_swing_(least_swing), longest_gap_(longest_gap) {}

  /// A component that alternates.
  struct Alternation {
    int turns{0};              // that follow one another; 0: it does not alternate
    double lasted{0.0};        // from the first turn to the last [s]
    double gap{0.0};           // between the last two turns [s]
    double swing{0.0};         // between the last two turns, peak to peak [N]
    double swing_before{0.0};  // between the two before them [N]
    double largest{0.0};       // of the component, at the last two turns [N]
    bool turned{false};        // on this tick
  };
  /// @param force      on the handle [N]
  /// @param accounted  the part of it that alternates by itself [N]
  /// @returns the longest train of the three components.
  Alternation look(const Eigen::Vector3d& force, const Eigen::Vector3d& accounted,
                   double dt) noexcept;

 private:
  /// A force may stay at its extreme, at a limit or without contact.
  struct Extreme {
    double force{0.0};  // [N]
    double from{0.0};   // [s]
    double until{0.0};  // [s]
  };
  struct Axis {
    Extreme highest;  // since the last turn
    Extreme lowest;
    int direction{0};         // +1 rising, -1 falling; 0: not known yet
    double turned_at{0.0};    // of the last turn, the middle of its extreme [s]
    double turned_from{0.0};  // the force there [N]
    Alternation train{};
  };
  double accounted_swing(const Eigen::Vector3d& accounted, double dt) noexcept;
  void look_at(Axis& axis, double force, double swing) const noexcept;
  void note_turn(Axis& axis, const Extreme& extreme) const noexcept;

  double least_swing_;
  double longest_gap_;
  double time_{0.0};  // [s]
  bool begun_{false};
  std::array<Axis, 3> axes_;
  Eigen::Vector3d slow_{Eigen::Vector3d::Zero()};  // of what is accounted for [N]
  double peak_{0.0};                               // of the rest of it, falling slowly [N]
};

}  // namespace haptrial::control
