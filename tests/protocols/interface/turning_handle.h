#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/control/loop_margin.h"
#include "core/device/device.h"

namespace haptrial::test {

inline constexpr double kFingers = 0.02;  // radius of the fingers about the axis of a rotation [m]

/// How a handle is read and driven.
struct HandleTiming {
  double tick{1e-3};    // [s]
  int force_delay{1};   // ticks until a force acts, 1 to 4
  int readings{8};      // of the slope that estimates velocity, 2 to 32
  double quantum{0.0};  // of the encoders, at the fingers; 0: none [m]
};

/// A handle that turns about y and opens and closes a gripper, each a mass at the fingers; forces
/// act late, and velocities are slopes over the last readings, as those of drivers.
class TurningHandle final : public device::Device {
 public:
  /// @param turning, opening  masses at the fingers, with that of a hand if one holds them [kg]
  TurningHandle(double turning, double opening, const HandleTiming& timing = {})
      : timing_(timing), rotation_{turning}, grip_{opening} {
    info_.simulated = true;
    info_.torque_axes = Eigen::Vector3d::Ones();
    info_.max_torque = 1.0;
    info_.max_grip_force = 20.0;
  }
  const device::DeviceInfo& info() const noexcept override { return info_; }
  bool read(device::DeviceReading& reading) noexcept override {
    constexpr double kTremble = 1e-9;  // so that no reading counts as frozen [m]
    device::DeviceReading now;
    now.tool.position.z() = ++reads_ % 2 == 0 ? kTremble : 0.0;
    now.orientation =
        Eigen::AngleAxisd(rotation_.seen(timing_) / kFingers, Eigen::Vector3d::UnitY());
    now.angular_velocity.y() = rotation_.slope(timing_) / kFingers;
    now.opening = grip_.seen(timing_);
    now.opening_speed = grip_.slope(timing_);
    if (on_read) {
      on_read(now);
    }
    reading = now;
    return !fails;
  }
  bool write(const device::Wrench& wrench) noexcept override {
    const device::Wrench late = late_[static_cast<std::size_t>(timing_.force_delay - 1)];
    rotation_.move(late.torque.y() / kFingers + hand_at_rotation, hand, friction, timing_);
    grip_.move(late.grip + hand_at_grip, hand, friction, timing_);
    std::rotate(late_.begin(), late_.end() - 1, late_.end());
    late_[0] = given = wrench;
    return true;
  }
  /// Both parts, at rest. @param where  at the fingers [m]
  void place(double where) {
    rotation_.place(where);
    grip_.place(where);
  }
  /// The hand lets go of both parts. @param bare  mass that is left of each [kg]
  void let_go(double bare) {
    hand = {};
    hand_at_rotation = hand_at_grip = 0.0;
    rotation_.mass = grip_.mass = bare;
  }

  double hand_at_rotation{0.0}, hand_at_grip{0.0};  // forces of a hand at the fingers [N]
  control::HeldBy hand;                             // its mass is that of the parts
  double friction{0.0};                             // of either part [N]
  bool fails{false};
  std::function<void(device::DeviceReading&)> on_read;
  device::Wrench given;

 private:
  struct Part {
    double mass;
    double at{0.0}, rest{0.0}, speed{0.0};
    std::array<double, 32> ring{};  // the latest readings, the newest first

    double seen(const HandleTiming& timing) const {
      return timing.quantum > 0.0 ? timing.quantum * std::nearbyint(at / timing.quantum) : at;
    }
    void place(double where) {
      at = rest = where;
      speed = 0.0;
      ring.fill(where);
    }
    double slope(const HandleTiming& timing) const {
      const int n = timing.readings;
      double sum = 0.0;
      for (int age = 0; age < n; ++age) {
        sum += (0.5 * (n - 1) - age) * ring[static_cast<std::size_t>(age)];
      }
      return 12.0 / (n * (n * n - 1.0) * timing.tick) * sum;
    }
    void move(double force, const control::HeldBy& hand, double friction,
              const HandleTiming& timing) {
      constexpr int kSteps = 4;
      const double h = timing.tick / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        speed += h / mass * (force - hand.damping * speed - hand.stiffness * (at - rest));
        const double held_back = friction / mass * h;
        speed = std::abs(speed) > held_back ? speed - std::copysign(held_back, speed) : 0.0;
        at += h * speed;
      }
      std::rotate(ring.begin(), ring.end() - 1, ring.end());
      ring[0] = seen(timing);
    }
  };

  HandleTiming timing_;
  device::DeviceInfo info_;
  Part rotation_, grip_;
  std::array<device::Wrench, 4> late_{};
  int reads_{0};
};

}  // namespace haptrial::test
