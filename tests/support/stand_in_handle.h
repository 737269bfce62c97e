#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "tests/support/stand_in.h"

namespace haptrial::test {

/// The handle behind a stand-in library: a mass on a damped spring, m = 0.5 kg, k = 200 N/m,
/// b = 20 N·s/m (critically damped), in metres and the vendor's axes.
///
/// With STAND_IN_HAND_TICKS=N in the environment a hand sweeps the handle along every axis between
/// 20% and 60% of N ticks and presses button 0 after 90%, as haptrial device-test asks for.
struct StandInHandle {
  static constexpr double kMass = 0.5;
  static constexpr double kStiffness = 200.0;
  static constexpr double kDamping = 20.0;
  using Vector = std::array<double, 3>;

  Vector position{};
  Vector velocity{};
  Vector anchor{};
  Vector force{};  // that the motors give [N]
  std::array<double, 9> turn{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};  // by rows
  bool wrist{false};   // it says how it is turned
  bool active{false};  // wrist and gripper have motors: masses on damped springs, as the tip is
  Vector spin{}, torque{}, turned{};           // [rad/s, N·m, rad]
  double gap{0.0}, gap_speed{0.0}, grip{0.0};  // [m, m/s, N]
  long ticks{0};
  unsigned buttons{0};
  bool forces_on{false};
  bool open{false};
  Failure failure{Failure::kNone};
  long failure_tick{0};
  StandInSetup setup{};

  void step(double dt) {
    ++ticks;
    move_hand();
    for (std::size_t i = 0; i < 3; ++i) {
      const double motor = forces_on ? force[i] : 0.0;
      velocity[i] +=
          dt / kMass * (motor - kStiffness * (position[i] - anchor[i]) - kDamping * velocity[i]);
      position[i] += dt * velocity[i];
    }
    if (active) {
      step_parts(dt);
    }
  }

  /// A wrist that turns by little, and a gripper that rests 20 mm open.
  void step_parts(double dt) {
    constexpr double kInertia = 1e-4;      // [kg·m²]
    constexpr double kTurning = 0.04;      // [N·m/rad]
    constexpr double kTurnDamping = 4e-3;  // [N·m·s/rad]
    constexpr double kRest = 0.02;         // [m]
    for (std::size_t i = 0; i < 3; ++i) {
      const double motor = forces_on ? torque[i] : 0.0;
      spin[i] += dt / kInertia * (motor - kTurning * turned[i] - kTurnDamping * spin[i]);
      turned[i] += dt * spin[i];
    }
    const double x = 0.5 * turned[0], y = 0.5 * turned[1], z = 0.5 * turned[2];
    const double w = std::sqrt(std::max(0.0, 1.0 - x * x - y * y - z * z));
    turn = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
            2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
            2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
    const double motor = forces_on ? grip : 0.0;
    gap_speed += dt / kMass * (motor - kStiffness * (gap - kRest) - kDamping * gap_speed);
    gap += dt * gap_speed;
  }

  bool fails(Failure what) const { return failure == what && ticks >= failure_tick; }

  void place(const double* where) {
    std::copy_n(where, 3, anchor.begin());
    position = anchor;
    velocity = {};
  }

  void note(const char* call) {
    if (std::strlen(setup.calls) + std::strlen(call) + 2 < sizeof setup.calls) {
      std::strcat(setup.calls, call);
      std::strcat(setup.calls, " ");
    }
  }

  void view(StandInView* out, double unit) const {
    for (std::size_t i = 0; i < 3; ++i) {
      out->position[i] = position[i] / unit;
      out->force[i] = forces_on ? force[i] : 0.0;
    }
    out->torque[0] = forces_on ? torque[0] : 0.0;
    out->torque[1] = forces_on ? torque[1] : 0.0;
    out->torque[2] = forces_on ? torque[2] : 0.0;
    out->grip = forces_on ? grip : 0.0;
    out->ticks = ticks;
    out->forces_on = forces_on;
    out->open = open;
  }

 private:
  void move_hand() {
    static const char* const asked = std::getenv("STAND_IN_HAND_TICKS");
    if (asked == nullptr) {
      return;
    }
    constexpr double kPi = 3.14159265358979;
    const double share = static_cast<double>(ticks) / std::atof(asked);
    const double sweep = (share - 0.2) / 0.4;  // of the time to move
    anchor = {};
    if (sweep > 0.0 && sweep < 1.0) {
      const auto axis = static_cast<std::size_t>(3.0 * sweep);
      anchor[axis] = 0.1 * std::sin(2.0 * kPi * (3.0 * sweep - static_cast<double>(axis)));
    }
    buttons = share > 0.9 ? 1u : 0u;
  }
};

}  // namespace haptrial::test
