#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychophysics/study/pursuit_quantities.h"
#include "core/base/random.h"

namespace haptrial::analysis::trials {
namespace {

/// A hand with gain 0.8 and a lag of 0.1 s at 0.3 Hz, gain 0.5 and 0.05 s at 1.1 Hz, and noise,
/// along a slanted line.
TEST(PursuitResponseTest, GainAndLagAreThoseOfTheHand) {
  const Eigen::Vector3d along = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  RandomStream random(1, "hand");
  std::vector<Eigen::Vector3d> target, hand;
  constexpr double kNoise = 0.001;
  for (int tick = 0; tick < 20'000; ++tick) {
    const double t = tick / 1000.0;
    const auto sine = [](double f, double at, double phase) {
      return std::sin(2.0 * M_PI * f * at + phase);
    };
    target.push_back((0.02 * sine(0.3, t, 1.0) + 0.01 * sine(1.1, t, 2.0)) * along);
    hand.push_back((0.016 * sine(0.3, t - 0.1, 1.0) + 0.005 * sine(1.1, t - 0.05, 2.0) +
                    kNoise * random.normal()) *
                   along);
  }
  const PursuitResponse found = pursuit_response(target, hand, 1000.0, {0.3, 1.1});
  EXPECT_NEAR(std::abs(found.response[0]), 0.8, 0.003);
  EXPECT_NEAR(std::abs(found.response[1]), 0.5, 0.005);
  EXPECT_NEAR(-std::arg(found.response[0]) / (2.0 * M_PI * 0.3), 0.1, 0.002);
  EXPECT_NEAR(-std::arg(found.response[1]) / (2.0 * M_PI * 1.1), 0.05, 0.002);
  const double movement = 0.5 * (0.016 * 0.016 + 0.005 * 0.005);
  EXPECT_NEAR(found.followed, movement / (movement + kNoise * kNoise), 0.002);
  double square = 0.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    square += (target[i] - hand[i]).squaredNorm() / 20'000.0;
  }
  EXPECT_NEAR(found.error, std::sqrt(square), 1e-12);
}

/// The drift lies across the swing and is far larger than it; the hand is 0.2 s late in both.
TEST(PursuitResponseTest, ADriftOfTheTargetIsNoPartOfItsSwing) {
  std::vector<Eigen::Vector3d> target, hand;
  const auto place = [](double t) {
    return Eigen::Vector3d(0.01 * t, 0.02 * std::sin(2.0 * M_PI * 0.13 * t + 1.0), 0.005 * t);
  };
  for (int tick = 0; tick < 38'000; ++tick) {
    target.push_back(place(tick / 1000.0));
    hand.push_back(place(tick / 1000.0 - 0.2));
  }
  const PursuitResponse found = pursuit_response(target, hand, 1000.0, {0.13});
  EXPECT_NEAR(std::abs(found.response[0]), 1.0, 1e-9);
  EXPECT_NEAR(-std::arg(found.response[0]) / (2.0 * M_PI * 0.13), 0.2, 1e-9);
  EXPECT_NEAR(found.followed, 1.0, 1e-9);
}

TEST(PursuitResponseTest, FrequenciesThatTheTargetLacksHaveNoGain) {
  std::vector<Eigen::Vector3d> target, hand;
  const auto place = [](double t) {
    return Eigen::Vector3d(0.02 * std::sin(2.0 * M_PI * 0.1 * t) + 0.01 * std::cos(3.1 * t), 0.0,
                           0.0);
  };
  for (int tick = 0; tick < 37'000; ++tick) {
    target.push_back(place(tick / 1000.0));
    hand.push_back(place(tick / 1000.0 - 0.2));
  }
  const double other = 3.1 / (2.0 * M_PI);  // [Hz]
  const PursuitResponse whole = pursuit_response(target, hand, 1000.0, {0.1, other, 0.4});
  EXPECT_NEAR(-std::arg(whole.response[0]) / (2.0 * M_PI * 0.1), 0.2, 1e-9);
  EXPECT_NEAR(-std::arg(whole.response[1]) / 3.1, 0.2, 1e-9);
  EXPECT_TRUE(std::isnan(whole.response[2].real()));
  EXPECT_TRUE(std::isnan(whole.followed));
  const PursuitResponse part = pursuit_response(target, hand, 1000.0, {0.1});
  EXPECT_TRUE(std::isnan(part.response[0].real()));  // the other sine leaks into it
}

/// What the hand does across the target's line is no error of the pursuit.
TEST(PursuitResponseTest, OnlyDirectionsCountInWhichTheTargetMoves) {
  std::vector<Eigen::Vector3d> target, hand;
  for (int tick = 0; tick < 1000; ++tick) {
    target.emplace_back(0.01 * std::sin(0.02 * tick), 0.0, 0.0);
    hand.emplace_back(target.back().x() + 0.003, 0.05, 0.0);
  }
  EXPECT_NEAR(pursuit_response(target, hand, 1000.0, {}).error, 0.003, 1e-12);
}

}  // namespace
}  // namespace haptrial::analysis::trials
