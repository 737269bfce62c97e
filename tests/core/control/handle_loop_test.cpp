#include "core/control/handle_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptrial::control {
namespace {

/// A free mass with a damper of the last difference of positions, d ticks late. On the stability
/// boundary z = exp(i theta) solves z - 1 = -(b T / 2 m) (z^-d + z^-(d+1)), which gives
/// b T / m = 2 tan(pi / (4 (d + 1))).
TEST(HandleLoopTest, ADelayedDamperOnAFreeMassIsStableUpToItsExactBound) {
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    for (const int delay : {1, 2, 3}) {
      const HandleLoop loop{0.01, rate, 2, delay};
      const double b = 300.0;
      const double exact = b / rate / (2.0 * std::tan(std::numbers::pi / (4.0 * (delay + 1))));
      const double found = lightest_stable_hand({0.0, b}, loop) + loop.handle_mass;
      EXPECT_NEAR(found, exact, 2e-3) << rate << " Hz, " << delay;
    }
  }
}

TEST(HandleLoopTest, WithoutForceAHeldHandComesToRestAndAFreeOneStays) {
  EXPECT_LT(spectral_radius({0.0, 0.0}, {}, {0.8, 15.0, 250.0}), 1.0);
  EXPECT_NEAR(spectral_radius({0.0, 0.0}, {}, {}), 1.0, 1e-6);
}

/// k T (d + 1/2) of damping is what a sampled spring takes away (Colgate and Schenkel 1997).
TEST(HandleLoopTest, ASpringNeedsAsMuchDampingAsItsDelayTakes) {
  for (const int delay : {1, 2, 3}) {
    const HandleLoop loop{0.2, 1000.0, 8, delay};
    const double k = 500.0;
    const double takes = k * 1e-3 * (delay + 0.5);
    EXPECT_GT(spectral_radius({k, 0.0}, loop, {0.8, 0.97 * takes, 0.0}), 1.0) << delay;
    EXPECT_LT(spectral_radius({k, 0.0}, loop, {0.8, 1.03 * takes, 0.0}), 1.0) << delay;
  }
}

TEST(HandleLoopTest, AHandOnASpringSwingsAtTheFrequencyOfAMassOnIt) {
  const HandleLoop loop{0.2, 4000.0, 8, 1};
  const double free = std::sqrt(5000.0 / 1.5) / (2.0 * std::numbers::pi);
  EXPECT_NEAR(dominant_frequency({5000.0, 0.0}, loop, {1.3, 0.0, 0.0}), free, 0.01);
}

TEST(HandleLoopTest, TheBareHandleCarriesItsShareOfDampingWithMargin) {
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    for (const int delay : {1, 2, 3}) {
      const HandleLoop loop{0.22, rate, 8, delay};
      const double b = damping_of_bare_handle(1e9, loop);
      for (const double k : {0.0, 900.0, 2000.0}) {
        EXPECT_LE(spectral_radius({k, b}, loop, {}), 1.0 + 1e-9)
            << rate << " " << delay << " " << k;
        EXPECT_LE(spectral_radius({k, 2.0 * b}, loop, {}), 1.0 + 1e-9) << "a margin of two";
      }
    }
  }
  EXPECT_EQ(damping_of_bare_handle(3.0, {}), 3.0) << "no more than is wanted";
}

TEST(HandleLoopTest, AStepOfTheEncoderLooksAsFastAsTheSlopeOfItsReadings) {
  for (const int n : {2, 5, 8, 31}) {
    constexpr double kRate = 4000.0;
    constexpr double kQuantum = 2e-5;
    double fastest = 0.0;
    for (int step = 1; step < n; ++step) {  // the readings from there on are one quantum higher
      double upper = 0.0;
      double lower = 0.0;
      for (int i = 0; i < n; ++i) {
        const double centred = i - 0.5 * (n - 1);
        upper += centred * (i >= step ? kQuantum : 0.0);
        lower += centred * centred;
      }
      fastest = std::max(fastest, upper / lower * kRate);
    }
    EXPECT_NEAR(velocity_of_a_step(kQuantum, n, kRate), fastest,
                n % 2 == 0 ? 1e-12 : 0.05 * fastest)
        << n;
  }
}

TEST(HandleLoopTest, TheLightestHandIsOnTheEdge) {
  const HandleLoop loop;
  const PdGains plane{2000.0, 300.0};
  const double hand = lightest_stable_hand(plane, loop);
  EXPECT_GT(hand, 0.3);
  EXPECT_LT(hand, 1.0);
  EXPECT_LT(spectral_radius(plane, loop, {hand + 0.01, 0.0, 0.0}), 1.0);
  EXPECT_GT(spectral_radius(plane, loop, {hand - 0.01, 0.0, 0.0}), 1.0);
  EXPECT_EQ(lightest_stable_hand({900.0, 20.0}, loop), 0.0) << "the bare handle carries it";
  EXPECT_EQ(lightest_stable_hand({900.0, 3000.0}, loop, 2.0), 3.0) << "no hand does";
}

TEST(HandleLoopTest, BadLoopsAreRefused) {
  EXPECT_THROW(spectral_radius({}, {0.0}, {}), std::invalid_argument);
  EXPECT_THROW(spectral_radius({}, {0.2, 0.0}, {}), std::invalid_argument);
  EXPECT_THROW(spectral_radius({}, {0.2, 1000.0, 1}, {}), std::invalid_argument);
  EXPECT_THROW(spectral_radius({}, {0.2, 1000.0, 8, 0}, {}), std::invalid_argument);
  EXPECT_THROW(spectral_radius({}, {}, {-0.1, 0.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::control
