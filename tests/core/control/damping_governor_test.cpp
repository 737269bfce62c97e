#include "core/control/damping_governor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace haptrial::control {
namespace {

constexpr double kLimit = 12.0;  // of the force [N]

struct Hand {
  double mass{0.0};       // beside the handle [kg]
  double damping{0.0};    // [N·s/m]
  double stiffness{0.0};  // [N/m]
};

/// A hand of this mass like that of the shipped study (0.8 kg, 15 N·s/m, 250 N/m).
Hand like_the_shipped(double mass) { return {mass, 15.0 * mass / 0.8, 250.0 * mass / 0.8}; }

/// One axis of spring, damper, device and hand, stepped by itself: nothing of the product but the
/// governor takes part.
class Axis {
 public:
  Axis(const PdGains& gains, const HandleLoop& loop, bool governed)
      : gains_(gains), loop_(loop), governed_(governed), governor_(gains.damping, loop) {
    readings_.assign(static_cast<std::size_t>(loop.velocity_window), 0.0);
    on_their_way_.assign(static_cast<std::size_t>(loop.force_delay), 0.0);
  }

  Hand hand;
  double knock{0.0};  // by somebody [N]
  double force{0.0};  // commanded [N]
  double share{1.0};

  void tick() {
    const double speed = slope();
    share = governed_ ? governor_.share({0.0, speed, 0.0}) : 1.0;
    force = std::clamp(-gains_.stiffness * readings_.front() - share * gains_.damping * speed,
                       -kLimit, kLimit);
    on_their_way_.push_back(force);
    move(on_their_way_.front());
    on_their_way_.erase(on_their_way_.begin());
    readings_.insert(readings_.begin(), 1e-5 * std::round(1e5 * position_));
    readings_.pop_back();
  }

  /// Seconds with the force at its limit over this time.
  double saturated(double seconds) {
    int ticks = 0;
    for (int i = 0; i < static_cast<int>(seconds * loop_.rate); ++i) {
      tick();
      ticks += std::abs(force) >= 0.98 * kLimit;
    }
    return ticks / loop_.rate;
  }

 private:
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
    const double h = 1.0 / loop_.rate / kSteps;
    const double mass = loop_.handle_mass + hand.mass;
    for (int i = 0; i < kSteps; ++i) {
      const double f = motor + knock - hand.stiffness * position_ - hand.damping * velocity_;
      velocity_ += f / mass * h;
      const double stop = kFriction / mass * h;
      velocity_ -= std::clamp(velocity_, -stop, stop);
      position_ += velocity_ * h;
    }
  }

  PdGains gains_;
  HandleLoop loop_;
  bool governed_;
  DampingGovernor governor_;
  std::vector<double> readings_;      // newest first [m]
  std::vector<double> on_their_way_;  // oldest first [N]
  double position_{0.0};
  double velocity_{0.0};
};

constexpr PdGains kPlane{2000.0, 300.0};
constexpr PdGains kTrajectory{900.0, 100.0};

template <typename Check>
void for_every_loop(Check check) {
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    for (const int delay : {1, 2, 3}) {
      for (const PdGains& gains : {kPlane, kTrajectory}) {
        SCOPED_TRACE(testing::Message()
                     << rate << " Hz, " << delay << " ticks, " << gains.stiffness << " N/m");
        check(gains, HandleLoop{0.22, rate, 8, delay});
      }
    }
  }
}

TEST(DampingGovernorTest, EveryHandIsQuietAfterAKnock) {
  for_every_loop([](const PdGains& gains, const HandleLoop& loop) {
    for (const double mass : {0.0, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0}) {
      for (const double knock : {0.5, 3.0, 10.0}) {
        Axis axis(gains, loop, true);
        axis.hand = like_the_shipped(mass);
        axis.saturated(2.0);  // until it has all the damping that it is going to have
        axis.knock = knock;
        double saturated = axis.saturated(0.02);
        axis.knock = 0.0;
        saturated += axis.saturated(2.0);
        EXPECT_LE(saturated, 0.025) << mass << " kg, knock of " << knock << " N";
        double loudest = 0.0;
        for (int i = 0; i < static_cast<int>(loop.rate); ++i) {
          axis.tick();
          loudest = std::max(loudest, std::abs(axis.force));
        }
        EXPECT_LT(loudest, 0.8) << mass << " kg, knock of " << knock << " N";
      }
    }
  });
}

TEST(DampingGovernorTest, WithoutItALightHandOscillatesAtTheLimit) {
  for (const double mass : {0.0, 0.1, 0.3, 0.5}) {
    Axis axis(kPlane, {}, false);
    axis.hand = like_the_shipped(mass);
    axis.knock = 3.0;
    axis.saturated(0.02);
    axis.knock = 0.0;
    EXPECT_GT(axis.saturated(2.0), 0.5) << mass;
  }
}

TEST(DampingGovernorTest, AHandleThatIsLetGoIsQuietAtOnce) {
  for_every_loop([](const PdGains& gains, const HandleLoop& loop) {
    Axis axis(gains, loop, true);
    axis.hand = like_the_shipped(0.8);
    axis.knock = 2.0;  // the hand presses
    axis.saturated(1.0);
    axis.hand = {};
    axis.knock = 0.0;
    EXPECT_LE(axis.saturated(0.2), 0.020);
    EXPECT_EQ(axis.saturated(3.0), 0.0);
  });
}

TEST(DampingGovernorTest, AHandThatCarriesItHasAllTheDamping) {
  Axis axis(kPlane, {}, true);
  axis.hand = like_the_shipped(1.5);
  for (int i = 0; i < 20'000; ++i) {  // moves, trembles and presses
    const double t = 1e-3 * i;
    axis.knock = 3.0 * std::sin(6.0 * t) + 0.1 * std::sin(2.0 * 3.14159 * 9.0 * t);
    axis.tick();
    ASSERT_TRUE(t < 1.5 || axis.share == 1.0) << t;
  }
  axis.knock = 10.0;  // a tap
  axis.saturated(0.02);
  axis.knock = 0.0;
  axis.saturated(0.1);
  EXPECT_LT(axis.share, 1.0);
  axis.saturated(4.0);
  EXPECT_EQ(axis.share, 1.0) << "given back";
}

TEST(DampingGovernorTest, ALightHandSettlesAtWhatItCarriesInsteadOfTryingAgainAndAgain) {
  Axis axis(kPlane, {}, true);
  axis.hand = like_the_shipped(0.1);
  axis.knock = 3.0;
  axis.saturated(0.02);
  axis.knock = 0.0;
  axis.saturated(5.0);
  int loud = 0;
  for (int i = 0; i < 10'000; ++i) {
    axis.knock = 0.6 * std::sin(2.0 * 3.14159 * 9.0 * 1e-3 * i);
    axis.tick();
    loud += std::abs(axis.force) > 2.0;
  }
  EXPECT_LE(loud, 100) << "of 10,000 ticks";
  EXPECT_LT(axis.share, 0.6);
}

TEST(DampingGovernorTest, VelocitiesThatAreNoNumbersDoNotSpoilIt) {
  DampingGovernor governor(300.0, {});
  governor.share({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  governor.share({0.0, std::numeric_limits<double>::infinity(), 0.0});
  for (int i = 0; i < 2000; ++i) {
    governor.share(Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(governor.share(Eigen::Vector3d::Zero()), 1.0);
}

TEST(DampingGovernorTest, NoDampingIsNothingToGovern) {
  DampingGovernor governor(0.0, {});
  EXPECT_EQ(governor.share({0.0, 1.0, 0.0}), 1.0);
  EXPECT_THROW(DampingGovernor(-1.0, {}), std::invalid_argument);
  EXPECT_THROW(DampingGovernor(1.0, {0.0}), std::invalid_argument);
}

TEST(DampingGovernorTest, ATickDoesNotAllocate) {
  DampingGovernor governor(300.0, {});
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    governor.share({0.0, 0.1 * std::sin(0.3 * i), 0.0});
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::control
