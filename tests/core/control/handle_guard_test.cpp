// A handle on a spring, a damper, a wall or a virtual mass, with every hand, stepped by itself: of
// the product nothing but the guard takes part.

#include "core/control/handle_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/support/allocation_guard.h"
#include "tests/support/swings.h"

namespace haptrial::control::handle_guard_test {
namespace {

using Eigen::Vector3d;

constexpr double kLimit = 8.0;  // of the force [N]

struct Hand {
  double mass{0.0};       // beside the handle [kg]
  double damping{0.0};    // [N·s/m]
  double stiffness{0.0};  // [N/m]
};

/// A hand of this mass like that of the shipped study (0.8 kg, 15 N·s/m, 250 N/m).
Hand like_the_shipped(double mass) { return {mass, 15.0 * mass / 0.8, 250.0 * mass / 0.8}; }

/// The feeling along one axis.
struct Law {
  const char* name;
  PdGains gains;
  double mass{0.0};       // virtual [kg]
  double limit{12.0};     // of the force, as a field has one [N]
  bool one_sided{false};  // a wall at 0
};

class Axis {
 public:
  Axis(const Law& law, const HandleLoop& loop, bool guarded)
      : law_(law), loop_(loop), guarded_(guarded), guard_(loop) {
    readings_.assign(static_cast<std::size_t>(loop.velocity_window), 0.0);
    on_their_way_.assign(static_cast<std::size_t>(loop.force_delay), 0.0);
  }

  Hand hand;
  double push{0.0};      // by somebody [N]
  double quantum{1e-5};  // of the encoder [m]
  double force{0.0};     // commanded [N]
  GainShares shares;

  void tick() {
    const double speed = slope();
    if (guarded_) {
      shares = guard_.watch({0.0, speed, 0.0}, {0.0, force, 0.0}, Vector3d::Zero(), period());
    }
    const double asked = std::clamp(law(speed), -law_.limit, law_.limit);
    force = std::clamp(asked + (guarded_ ? guard_.calming().y() : 0.0), -kLimit, kLimit);
    on_their_way_.push_back(force);
    move(on_their_way_.front());
    on_their_way_.erase(on_their_way_.begin());
    readings_.insert(readings_.begin(), quantum * std::round(position_ / quantum));
    readings_.pop_back();
  }

  /// The forces over this time.
  std::vector<double> forces(double seconds) {
    std::vector<double> all;
    for (int i = 0; i < static_cast<int>(seconds * loop_.rate); ++i) {
      tick();
      all.push_back(force);
    }
    return all;
  }

 private:
  double period() const { return 1.0 / loop_.rate; }
  double law(double speed) {
    constexpr double kCutoff = 30.0;  // of the acceleration [Hz]
    const double acceleration = (speed - speed_) / period();
    speed_ = speed;
    acceleration_ += (1.0 - std::exp(-2.0 * std::numbers::pi * kCutoff * period())) *
                     (acceleration - acceleration_);
    const double at = readings_.front();
    const double spring = -shares.stiffness * law_.gains.stiffness * at;
    const double damper =
        -shares.damping * (law_.gains.damping * speed + law_.mass * acceleration_);
    if (law_.one_sided) {
      return at < 0.0 ? std::max(0.0, spring + damper) : 0.0;
    }
    return spring + damper;
  }
  double slope() const {
    const int n = loop_.velocity_window;
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < n; ++i) {
      const double centred = 0.5 * (n - 1) - i;
      sum += centred * readings_[static_cast<std::size_t>(i)];
      squares += centred * centred;
    }
    return sum / squares * loop_.rate;
  }
  void move(double motor) {
    constexpr int kSteps = 4;
    constexpr double kFriction = 0.1;  // [N]
    const double h = period() / kSteps;
    const double mass = loop_.handle_mass + hand.mass;
    for (int i = 0; i < kSteps; ++i) {
      const double f = motor + push - hand.stiffness * position_ - hand.damping * velocity_;
      velocity_ += f / mass * h;
      const double stop = kFriction / mass * h;
      velocity_ -= std::clamp(velocity_, -stop, stop);
      position_ += velocity_ * h;
    }
  }

  Law law_;
  HandleLoop loop_;
  bool guarded_;
  HandleGuard guard_;
  std::vector<double> readings_;      // newest first [m]
  std::vector<double> on_their_way_;  // oldest first [N]
  double position_{0.0};
  double velocity_{0.0};
  double speed_{0.0};         // as read on the tick before [m/s]
  double acceleration_{0.0};  // [m/s²]
};

/// Grasped, pressed with 3 N, knocked, and let go.
std::vector<double> handled(Axis& axis) {
  std::vector<double> all;
  const auto go_on = [&](double push, double seconds) {
    axis.push = push;
    const std::vector<double> more = axis.forces(seconds);
    all.insert(all.end(), more.begin(), more.end());
  };
  go_on(0.0, 0.5);
  go_on(-3.0, 1.0);
  go_on(-9.0, 0.02);
  go_on(-3.0, 1.0);
  go_on(0.0, 0.5);
  return all;
}

const std::vector<Law>& laws() {
  static const std::vector<Law> all{
      {"the source's plane, limited", {2000.0, 300.0}, 0.0, 5.0},
      {"the source's plane", {2000.0, 300.0}},
      {"the source's trajectory", {900.0, 100.0}},
      {"a damper", {0.0, 100.0}},
      {"a virtual mass", {0.0, 0.0}, 2.0, 5.0},
      {"a virtual mass on a spring", {300.0, 0.0}, 2.0},
      {"a spring", {2000.0, 0.0}},
      {"a soft wall", {800.0, 2.0}, 0.0, 8.0, true},
      {"a stiff wall", {5000.0, 0.0}, 0.0, 8.0, true},
      {"a wall with a damper", {2000.0, 300.0}, 0.0, 5.0, true},
  };
  return all;
}

constexpr double kMasses[] = {0.001, 0.02, 0.05, 0.15, 0.3, 0.5, 0.8, 2.0};  // [kg]

TEST(HandleGuardTest, NoHandOscillatesForLongerThanAFifthOfASecond) {
  for (const Law& law : laws()) {
    for (const double rate : {1000.0, 2000.0, 4000.0}) {
      for (const int delay : {1, 2}) {
        const auto window = static_cast<int>(std::lround(0.008 * rate));
        for (const double mass : kMasses) {
          Axis axis(law, {0.22, rate, window, delay}, true);
          axis.hand = like_the_shipped(mass);
          EXPECT_LE(test::longest_train(handled(axis), rate), 0.2)
              << law.name << ", " << mass << " kg, " << rate << " Hz, " << delay << " ticks";
        }
      }
    }
  }
}

/// The damper that calms must not be what oscillates.
TEST(HandleGuardTest, StepsOfACoarseEncoderTakeNoWallAway) {
  for (const double quantum : {1e-5, 3e-5, 1e-4}) {
    for (const double mass : {0.15, 0.3, 0.8}) {
      Axis axis({"a wall", {1000.0, 3.0}, 0.0, 8.0, true},
                {0.22, 1000.0, 2, 1, velocity_of_a_step(quantum, 2, 1000.0)}, true);
      axis.quantum = quantum;
      axis.hand = like_the_shipped(mass);
      axis.push = -4.0;
      axis.forces(2.0);
      const double pressed = 4.0 / (1000.0 + axis.hand.stiffness);  // [m]
      const double step = (1000.0 + 3.0 * 1000.0) * quantum + 0.25;
      for (const double force : axis.forces(1.0)) {
        ASSERT_NEAR(force, 1000.0 * pressed, 3.0 * step) << quantum << " m, " << mass << " kg";
      }
      EXPECT_GT(axis.shares.stiffness, 0.95) << quantum << " m, " << mass << " kg";
    }
  }
}

TEST(HandleGuardTest, WithoutItLightHandsOscillate) {
  for (const std::size_t law : {0u, 1u, 4u, 9u}) {
    Axis axis(laws()[law], {}, false);
    axis.hand = like_the_shipped(0.15);
    EXPECT_GT(test::longest_train(handled(axis), 1000.0), 0.5) << laws()[law].name;
  }
}

TEST(HandleGuardTest, AHandThatCarriesItHasAllTheGains) {
  Axis axis(laws()[1], {}, true);
  axis.hand = like_the_shipped(1.5);
  for (int i = 0; i < 20'000; ++i) {  // moves, trembles and presses
    const double t = 1e-3 * i;
    axis.push = 3.0 * std::sin(6.0 * t) + 0.1 * std::sin(2.0 * std::numbers::pi * 9.0 * t);
    axis.tick();
    ASSERT_EQ(axis.shares.damping, 1.0) << t;
    ASSERT_EQ(axis.shares.stiffness, 1.0) << t;
  }
}

/// A tremor of 0.5 N (root mean square) may be in resonance with a wall. Who leans on the wall
/// would fall if it gave way. Hands that carry the wall.
TEST(HandleGuardTest, ATremblingHandKeepsAllThatItLeansOn) {
  for (const double stiffness : {500.0, 1000.0, 2000.0}) {
    for (const double mass : {0.3, 0.8, 2.0}) {
      const PdGains wall{stiffness, 2.0};
      if (!is_calm(wall, {}, held_by_hand(mass))) {
        continue;
      }
      for (const double hertz : {8.0, 9.0, 10.0, 11.0, 12.0}) {
        Axis axis({"", wall, 0.0, 8.0, true}, {}, true);
        axis.hand = like_the_shipped(mass);
        for (int i = 0; i < 5000; ++i) {
          axis.push = -4.0 * std::min(1.0, 1e-3 * i) +
                      0.71 * std::sin(2.0 * std::numbers::pi * hertz * 1e-3 * i);
          axis.tick();
          ASSERT_EQ(axis.shares.stiffness, 1.0)
              << stiffness << " N/m, " << mass << " kg, " << hertz << " Hz, tick " << i;
          if (i > 1000) {  // the first touch is a knock
            ASSERT_EQ(axis.shares.damping, 1.0)
                << stiffness << " N/m, " << mass << " kg, " << hertz << " Hz, tick " << i;
          }
        }
      }
    }
  }
}

TEST(HandleGuardTest, GainsComeBackWhenTheHandIsHeavyAgain) {
  Axis axis(laws()[1], {}, true);
  axis.hand = like_the_shipped(0.05);
  handled(axis);
  EXPECT_LT(axis.shares.damping, 1.0);
  axis.hand = like_the_shipped(2.0);
  axis.push = 0.0;
  axis.forces(20.0);
  EXPECT_GT(axis.shares.damping, 0.95);
  EXPECT_EQ(axis.shares.stiffness, 1.0);
}

TEST(HandleGuardTest, NoStepComesOfGivingWay) {
  Axis axis(laws()[8], {0.22, 1000.0, 8, 3}, true);
  axis.hand = like_the_shipped(0.15);
  GainShares before;
  axis.push = -3.0;
  for (int i = 0; i < 5000; ++i) {
    axis.tick();
    ASSERT_LE(std::abs(axis.shares.stiffness - before.stiffness), 0.0801) << i;
    ASSERT_LE(std::abs(axis.shares.damping - before.damping), 0.0801) << i;
    before = axis.shares;
  }
}

TEST(HandleGuardTest, VelocitiesThatAreNoNumbersDoNotSpoilIt) {
  HandleGuard guard({});
  for (const double v :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const GainShares& shares = guard.watch({v, 0.0, 0.0}, Vector3d::Zero(), Vector3d::Zero(), 1e-3);
    EXPECT_EQ(shares.damping, 1.0);
    EXPECT_TRUE(guard.calming().allFinite());
  }
}

TEST(HandleGuardTest, ALoopThatCannotBeIsRefused) {
  EXPECT_THROW(HandleGuard({0.0}), std::invalid_argument);
  EXPECT_THROW(HandleGuard({0.22, 0.0}), std::invalid_argument);
  EXPECT_THROW(HandleGuard({0.22, 1000.0, 1}), std::invalid_argument);
}

TEST(HandleGuardTest, ATickDoesNotAllocate) {
  HandleGuard guard({});
  const test::AllocationGuard allocations;
  for (int i = 0; i < 1000; ++i) {
    guard.watch({1e-2 * std::sin(i), 0.0, 0.0}, {5.0 * std::sin(0.3 * i), 0.0, 0.0},
                Vector3d::Zero(), 1e-3);
  }
  EXPECT_EQ(allocations.count(), 0u);
}

}  // namespace
}  // namespace haptrial::control::handle_guard_test
