// Laws of single fields against closed forms.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/scene/detent.h"
#include "core/scene/fade.h"
#include "core/scene/friction.h"
#include "core/scene/inertia.h"
#include "core/scene/low_pass.h"
#include "core/scene/mover.h"
#include "core/scene/path.h"
#include "core/scene/push.h"
#include "core/scene/vibration.h"
#include "tests/core/scene/spectrum.h"
#include "tests/support/message_of.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

const Vector3d kOrigin = Vector3d::Zero();
using haptrial::test::spectrum;
using testing::HasSubstr;

constexpr double kRate = 1000.0;
constexpr double kPi = std::numbers::pi;
const Setting kSetting{10.0, kRate};

Felt at_time(double time) { return {{}, time, nullptr}; }
Felt at_place(const Vector3d& p) { return {{p, Vector3d::Zero()}, 0.0, nullptr}; }

// --- fades ------------------------------------------------------------------------------------

TEST(FadeTest, FollowsItsClosedForm) {
  Fade fade;
  fade.turn(true, 0.4);
  for (int i = 1; i <= 500; ++i) {
    const double u = std::min(i * 1e-3 / 0.4, 1.0);
    ASSERT_NEAR(fade.next(1e-3), 3.0 * u * u - 2.0 * u * u * u, 1e-12);
  }
}

/// The largest change of the slope between steps, through fades that are turned in the middle.
double largest_kink(double dt) {
  Fade fade;
  double before = 0.0;
  double slope = 0.0;
  double largest = 0.0;
  for (int i = 0; i * dt < 1.5; ++i) {
    const auto reached = [&](double time) { return std::abs(i * dt - time) < 0.5 * dt; };
    if (reached(0.0) || reached(0.31)) {
      fade.turn(true, 0.5);
    } else if (reached(0.2) || reached(0.9)) {
      fade.turn(false, 0.3);
    }
    const double now = fade.next(dt);
    EXPECT_GE(now, 0.0);
    EXPECT_LE(now, 1.0);
    largest = std::max(largest, std::abs((now - before) / dt - slope));
    slope = (now - before) / dt;
    before = now;
  }
  return largest;
}

TEST(FadeTest, TheSlopeIsContinuousAlsoWhereAFadeIsTurned) {
  // A jump of the slope would stay as the steps get smaller; the change over a step shrinks with
  // it.
  EXPECT_LT(largest_kink(1e-3), 0.2);
  EXPECT_LT(largest_kink(1e-4), 0.12 * largest_kink(1e-3));
  EXPECT_LT(largest_kink(1e-5), 0.12 * largest_kink(1e-4));
}

TEST(FadeTest, NoDurationSteps) {
  Fade fade;
  fade.turn(true, 0.0);
  EXPECT_EQ(fade.weight(), 1.0);
  EXPECT_TRUE(fade.over());
  fade.turn(false, 0.0);
  EXPECT_EQ(fade.weight(), 0.0);
}

TEST(LowPassTest, AtTheCutOffTheAmplitudeIsThatOfAFirstOrderLag) {
  constexpr double kCutoff = 20.0;
  LowPass filter(kCutoff, kRate);
  filter.start(Vector3d::Zero());
  double largest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d y = filter.next(Vector3d(std::sin(2.0 * kPi * kCutoff * i / kRate), 0.0, 0.0));
    largest = i < 2000 ? 0.0 : std::max(largest, y.x());
  }
  EXPECT_NEAR(largest, std::sqrt(0.5), 0.02 * std::sqrt(0.5));
}

TEST(LowPassTest, AStepFollowsTheExponential) {
  LowPass filter(15.0, kRate);
  filter.start(Vector3d::Zero());
  for (int i = 1; i < 100; ++i) {
    ASSERT_NEAR(filter.next(Vector3d::UnitZ()).z(), 1.0 - std::exp(-2.0 * kPi * 15.0 * i / kRate),
                1e-12);
  }
}

// --- pushes -----------------------------------------------------------------------------------

TEST(PushTest, ARampRisesAndStays) {
  Ramp ramp({{1.0, 0.0, 0.0}, {3.0, 0.0, -4.0}, 2.0}, kSetting);
  FieldState state;
  EXPECT_EQ(ramp.force(at_time(0.0), state), Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(ramp.force(at_time(0.5), state), Vector3d(1.5, 0.0, -1.0));
  EXPECT_FALSE(state.done);
  EXPECT_EQ(ramp.force(at_time(7.0), state), Vector3d(3.0, 0.0, -4.0));
  EXPECT_TRUE(state.done);
}

TEST(PushTest, APulseHasItsDelayDurationAndImpulse) {
  Pulse pulse({{0.0, 2.0, 0.0}, 0.1, 0.3, 0.05}, kSetting);
  FieldState state;
  double impulse = 0.0;
  for (double t = 5e-6; t < 0.6; t += 1e-5) {
    const double force = pulse.force(at_time(t), state).y();
    ASSERT_EQ(force != 0.0, t > 0.1 && t < 0.4) << t;
    impulse += 1e-5 * force;
  }
  EXPECT_NEAR(impulse, 2.0 * (0.3 - 0.05), 1e-8) << "each edge is worth half its duration";
  EXPECT_NEAR(pulse.force(at_time(0.125), state).y(), 1.0, 1e-12);
}

TEST(PushTest, AMeasuredValueIsFollowedAndAMissingOneGivesNoForce) {
  Measured measured({1, 0.5, {0.0, 4.0, 0.0}}, kSetting);
  FieldState state;
  Felt felt = at_time(0.0);
  const std::array<double, 2> values{9.0, 2.0};
  felt.channels = values;
  EXPECT_EQ(measured.force(felt, state), Vector3d(0.0, 6.0, 0.0));
  const std::array<double, 2> others{9.0, 0.5};
  felt.channels = others;
  double before = 6.0;
  for (int i = 0; i < 40;
       ++i) {  // 10 N, its limit, in 50 ms: the value jumps, and the force does not
    const double force = measured.force(felt, state).y();
    ASSERT_LE(before - force, 10.0 / (0.05 * kRate) + 1e-12);
    before = force;
  }
  EXPECT_EQ(measured.force(felt, state), Vector3d::Zero());
  EXPECT_EQ(state.stimulus, Vector3d::Zero());
  Measured without({2, 0.5, {0.0, 4.0, 0.0}}, kSetting);
  EXPECT_EQ(without.force(felt, state), Vector3d::Zero()) << "there is no such channel";
}

/// The instrument gives 6 N, falls silent for 0.1 s, and comes back.
TEST(PushTest, AMeasuredValueThatGoesAndComesMakesNoStep) {
  Measured measured({0, 0.0, {0.0, 1.0, 0.0}}, kSetting);
  FieldState state;
  const std::array<double, 1> value{6.0};
  const std::array<double, 1> lost{NAN};
  double before = 6.0;
  for (int i = 0; i < 400; ++i) {
    Felt felt = at_time(1e-3 * i);
    felt.channels = i < 100 || i >= 200 ? value : lost;
    const double force = measured.force(felt, state).y();
    ASSERT_NEAR(force, before, 6.0 / 50.0 + 1e-12) << i;
    if (i < 100 || i >= 250) {
      ASSERT_NEAR(force, 6.0, 1e-9) << i;
    } else if (i >= 150 && i < 200) {
      ASSERT_NEAR(force, 0.0, 1e-9) << i;
    }
    before = force;
  }
}

TEST(PushTest, FastChangesOfAMeasuredValueAreAStimulusIfTheDefinitionSaysSo) {
  MeasuredParameters p{0, 0.0, {0.0, 1.0, 0.0}};
  p.stimulus = true;
  Measured measured(p, kSetting);
  FieldState state;
  Vector3d most = Vector3d::Zero();
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i;
    const std::array<double, 1> value{3.0 + std::sin(2.0 * std::numbers::pi * 50.0 * t)};
    Felt felt = at_time(t);
    felt.channels = value;
    measured.force(felt, state);
    most = i > 1000 ? Vector3d(most.cwiseMax(state.stimulus)) : most;
  }
  EXPECT_NEAR(most.y(), 1.0, 0.05) << "the sine is a stimulus, the 3 N are none";
}

// --- inertia ----------------------------------------------------------------------------------

/// The largest acceleration in the last tenth of `ticks`, of a free mass that carries a virtual one
/// and was pushed once: the drift that stays has none.
double swing_of(double virtual_mass, double cutoff, const InertiaLoop& loop, int ticks) {
  const double T = 1.0 / loop.rate;
  Inertia inertia({virtual_mass, cutoff}, {1e9, loop.rate});
  std::vector<double> readings(static_cast<std::size_t>(loop.velocity_window), 0.0);
  std::vector<double> coming(static_cast<std::size_t>(loop.force_delay), 0.0);
  double x = 0.0;
  double v = 1e-3;
  double largest = 0.0;
  inertia.start({});
  for (int i = 0; i < ticks; ++i) {
    readings.insert(readings.begin(), x);
    readings.pop_back();
    const int n = loop.velocity_window;
    double slope = 0.0;
    double squares = 0.0;
    for (int k = 0; k < n; ++k) {
      const double c = 0.5 * (n - 1) - k;
      slope += c * readings[static_cast<std::size_t>(k)];
      squares += c * c;
    }
    Felt felt{{Vector3d(x, 0.0, 0.0), Vector3d(slope / squares / T, 0.0, 0.0)}, i * T, nullptr};
    FieldState state;
    coming.push_back(inertia.force(felt, state).x());
    const double a = coming.front() / loop.moved_mass;
    coming.erase(coming.begin());
    if (i >= ticks - ticks / 10) {
      largest = std::max(largest, std::abs(a));
    }
    x += v * T + 0.5 * a * T * T;
    v += a * T;
  }
  return largest;
}

TEST(InertiaTest, TheLargestStableMassHasItsClosedForm) {
  for (const double cutoff : {5.0, 20.0, 80.0}) {
    const InertiaLoop loop{0.3, kRate, 2, 0};
    const double p = std::exp(-2.0 * kPi * cutoff / kRate);
    EXPECT_NEAR(largest_stable_mass(cutoff, loop), 2.0 * 0.3 / (1.0 - p), 1e-6);
  }
}

TEST(InertiaTest, BelowTheLargestStableMassItSettlesAboveItGrows) {
  for (const InertiaLoop& loop : {InertiaLoop{0.3, kRate, 2, 0}, InertiaLoop{0.22, kRate, 8, 1},
                                  InertiaLoop{1.0, 2000.0, 5, 3}}) {
    const double largest = largest_stable_mass(20.0, loop);
    EXPECT_GT(largest, 0.0);
    EXPECT_LT(swing_of(0.97 * largest, 20.0, loop, 4000),
              1e-3 * swing_of(0.97 * largest, 20.0, loop, 400));
    EXPECT_GT(swing_of(1.03 * largest, 20.0, loop, 4000),
              1e3 * swing_of(1.03 * largest, 20.0, loop, 400));
  }
}

TEST(InertiaTest, AHandThatPushesMovesBothMasses) {
  Inertia inertia({0.5, 30.0}, kSetting);
  inertia.start({});
  FieldState state;
  double v = 0.0;
  double reached = 0.0;
  for (int i = 0; i < 1000; ++i) {
    Felt felt{{Vector3d::Zero(), Vector3d(v, 0.0, 0.0)}, 0.0, nullptr};
    const double a = (2.0 + inertia.force(felt, state).x()) / 0.3;
    v += a / kRate;
    reached = a;
  }
  EXPECT_NEAR(reached, 2.0 / (0.3 + 0.5), 1e-6);
}

// --- friction ---------------------------------------------------------------------------------

/// Forces along x over a way of equal steps from `from` to `to`; the friction goes on where it was.
std::vector<double> stroke(Friction& friction, double from, double to, int steps, double& time,
                           FieldState& state) {
  std::vector<double> forces;
  for (int i = 1; i <= steps; ++i) {
    time += 1e-3;
    Felt felt{
        {Vector3d(from + (to - from) * i / steps, 0.0, 0.0), Vector3d::Zero()}, time, nullptr};
    forces.push_back(friction.force(felt, state).x());
  }
  return forces;
}

TEST(FrictionTest, BreaksAwayAtTheStaticLevelAndSlidesAtTheDynamicOne) {
  Friction friction({"", 1.5, 1.0, 2000.0}, kSetting);
  friction.start({});
  FieldState state;
  double time = 0.0;
  const std::vector<double> forces = stroke(friction, 0.0, 0.01, 10000, time, state);
  const auto strongest = std::min_element(forces.begin(), forces.end());
  EXPECT_NEAR(*strongest, -1.5, 2000.0 * 1.01e-6) << "within a step of the bristle";
  EXPECT_NEAR(static_cast<double>(strongest - forces.begin() + 1) * 1e-6, 1.5 / 2000.0, 2e-6);
  for (auto after = strongest + 2; after != forces.end(); ++after) {
    ASSERT_NEAR(*after, -1.0, 1e-9);
  }
  EXPECT_TRUE(state.sliding);
}

TEST(FrictionTest, AWayBackAndForthCostsForceTimesDistance) {
  for (const auto model : {FrictionParameters::Model::kBristle, FrictionParameters::Model::kDahl}) {
    constexpr double kForce = 0.8;
    constexpr double kStiffness = 2000.0;
    Friction friction({"", kForce, kForce, kStiffness, model}, kSetting);
    friction.start({});
    FieldState state;
    double time = 0.0;
    constexpr double kWay = 0.2;
    constexpr int kSteps = 20000;
    stroke(friction, 0.0, kWay, kSteps, time, state);
    double work = 0.0;
    for (const double f : stroke(friction, kWay, 0.0, kSteps, time, state)) {
      work -= f * kWay / kSteps;
    }
    for (const double f : stroke(friction, 0.0, kWay, kSteps, time, state)) {
      work += f * kWay / kSteps;
    }
    // Turning back, the bristle gives back and takes anew: 2 z_max of each way for Coulomb's law,
    // where the mean force is 0, and the same for Dahl's, from the area under its exponential.
    const double lost_way = 2.0 * kForce / kStiffness;
    EXPECT_NEAR(work, -kForce * 2.0 * (kWay - lost_way), 4.0 * kForce * kWay / kSteps)
        << "within a step at each end, model " << static_cast<int>(model);
    EXPECT_NEAR(work / (-kForce * 2.0 * kWay), 1.0, 0.005);
  }
}

TEST(FrictionTest, DahlsModelFollowsItsExponential) {
  Friction friction({"", 1.0, 1.0, 1000.0, FrictionParameters::Model::kDahl}, kSetting);
  friction.start({});
  FieldState state;
  double time = 0.0;
  const std::vector<double> forces = stroke(friction, 0.0, 0.005, 50000, time, state);
  for (std::size_t i = 0; i < forces.size(); i += 500) {
    const double x = 1e-7 * static_cast<double>(i + 1);
    ASSERT_NEAR(forces[i], -(1.0 - std::exp(-1000.0 * x)), 1e-4);
  }
}

TEST(FrictionTest, AMassDraggedByASpringSticksAndSlipsOnlyIfTheLevelsDiffer) {
  const auto slips = [](double static_level) {
    Friction friction({"", static_level, 1.0, 20000.0}, kSetting);
    friction.start({});
    double x = 0.0;
    double v = 0.0;
    int count = 0;
    bool fast = false;
    constexpr double kStep = 1e-4;
    for (int i = 0; i < 100000; ++i) {
      FieldState state;
      Felt felt{{Vector3d(x, 0.0, 0.0), Vector3d(v, 0.0, 0.0)}, i * kStep, nullptr};
      const double pulled = 100.0 * (0.01 * i * kStep - x);
      const double force = friction.force(felt, state).x() + pulled - 1.0 * v;
      v += kStep * force / 0.1;
      x += kStep * v;
      count += !fast && v > 0.03;
      fast = v > 0.03 || (fast && v > 0.01);
    }
    return count;
  };
  EXPECT_GE(slips(2.0), 4)
      << "pulled 0.1 m; a slip lets the spring go by about 2 (2 - 1) N / 100 N/m";
  EXPECT_LE(slips(2.0), 8);
  EXPECT_EQ(slips(1.0), 0);
}

TEST(FrictionTest, StepsOfAnEncoderAreNoStops) {
  // 2 mm/s in steps of 10 µm: most ticks see no way at all.
  Friction friction({"", 1.5, 1.0, 2000.0}, kSetting);
  friction.start({});
  FieldState state;
  for (int i = 1; i < 5000; ++i) {
    const double x = 1e-5 * std::floor(2e-6 * i / 1e-5);
    Felt felt{{Vector3d(x, 0.0, 0.0), Vector3d::Zero()}, i * 1e-3, nullptr};
    const double force = friction.force(felt, state).x();
    if (x > 0.001) {
      ASSERT_NEAR(force, -1.0, 1e-9) << i;
    }
  }
}

TEST(FrictionTest, AfterARestItBreaksAwayAnew) {
  Friction friction({"", 1.5, 1.0, 2000.0}, kSetting);
  friction.start({});
  FieldState state;
  double time = 0.0;
  stroke(friction, 0.0, 0.01, 1000, time, state);
  stroke(friction, 0.01, 0.01, 100, time, state);
  EXPECT_FALSE(state.sliding);
  const std::vector<double> forces = stroke(friction, 0.01, 0.02, 10000, time, state);
  EXPECT_NEAR(*std::min_element(forces.begin(), forces.end()), -1.5, 2000.0 * 1.01e-6);
}

TEST(FrictionTest, OnASurfaceItIsTangentAndInProportionToThePressing) {
  Friction friction({"floor", 0.5, 0.5, 1000.0}, kSetting);
  friction.start({});
  const Vector3d normal = Vector3d(1.0, 2.0, 0.5).normalized();
  const Vector3d along = normal.cross(Vector3d::UnitX()).normalized();
  FieldState state;
  RandomStream random(1, "friction");
  for (int i = 1; i < 2000; ++i) {
    const SurfaceTouch touch{normal, 2.0 + std::sin(0.01 * i), 0.0};
    Felt felt{
        {1e-4 * i * along + 1e-4 * random.normal() * normal, Vector3d::Zero()}, 1e-3 * i, &touch};
    const Vector3d force = friction.force(felt, state);
    ASSERT_NEAR(force.dot(normal), 0.0, 1e-9);
    if (i > 200) {
      ASSERT_NEAR(force.dot(along), -0.5 * touch.pressing, 1e-9);
    }
  }
  const SurfaceTouch nothing{normal, 0.0, 0.0};
  Felt felt{{0.3 * along, Vector3d::Zero()}, 2.0, &nothing};
  EXPECT_EQ(friction.force(felt, state).norm(), 0.0);
}

// --- vibration --------------------------------------------------------------------------------

template <class Vibration>
std::vector<double> heard(Vibration& vibration, std::size_t ticks, const Vector3d& along) {
  std::vector<double> signal(ticks);
  FieldState state;
  for (std::size_t i = 0; i < ticks; ++i) {
    signal[i] = vibration.force(at_time(static_cast<double>(i) / kRate), state).dot(along);
  }
  return signal;
}

TEST(VibrationTest, ASineHasOnePeakAtItsFrequencyWithItsAmplitude) {
  SineVibration sine({{3.0, 0.0, 4.0}, 0.7, 173.0, 0.4}, kSetting);
  const std::vector<double> amplitude = spectrum(heard(sine, 1000, {0.6, 0.0, 0.8}));
  const auto peak = std::max_element(amplitude.begin(), amplitude.end()) - amplitude.begin();
  EXPECT_EQ(peak, 173);
  EXPECT_NEAR(amplitude[173], 0.7, 1e-9);
  EXPECT_LT(amplitude[170], 1e-9);
}

TEST(VibrationTest, NoiseStaysInItsBandAndHasItsPower) {
  NoiseVibration noise({Vector3d::UnitX(), 0.3, 80.0, 120.0, 7}, kSetting);
  noise.start({});
  const std::vector<double> signal = heard(noise, 20000, Vector3d::UnitX());
  double squares = 0.0;
  for (const double x : signal) {
    squares += x * x;
  }
  EXPECT_NEAR(std::sqrt(squares / 20000.0), 0.3, 0.003);
  const std::vector<double> first(signal.begin(), signal.begin() + 1000);
  const std::vector<double> amplitude = spectrum(first);
  double inside = 0.0;
  double outside = 0.0;
  for (std::size_t k = 0; k < amplitude.size(); ++k) {
    const bool in_band = k >= 75 && k <= 125;  // a Hann window's leakage reaches a few hertz
    (in_band ? inside : outside) += amplitude[k] * amplitude[k];
  }
  EXPECT_LT(outside, 1e-4 * inside);
  EXPECT_GT(inside, 0.0);
}

TEST(VibrationTest, TheSameSeedGivesTheSameNoise) {
  const auto noise = [](std::uint64_t seed) {
    NoiseVibration vibration({Vector3d::UnitX(), 0.3, 80.0, 120.0, seed}, kSetting);
    return heard(vibration, 100, Vector3d::UnitX());
  };
  EXPECT_EQ(noise(3), noise(3));
  EXPECT_NE(noise(3), noise(4));
}

TEST(VibrationTest, ATapDecays) {
  Tap tap({"", Vector3d::UnitY(), 2.0, 200.0, 0.01}, kSetting);
  tap.start({});
  FieldState state;
  for (double t = 0.0; t < 0.05; t += 1e-3) {
    ASSERT_NEAR(tap.force(at_time(t), state).y(),
                2.0 * std::exp(-t / 0.01) * std::sin(2.0 * kPi * 200.0 * t), 1e-12);
  }
}

TEST(VibrationTest, ATapOnASurfaceGrowsWithTheSpeedOfTheImpact) {
  const auto strength = [](double speed) {
    Tap tap({"floor", Vector3d::UnitX(), 10.0, 200.0, 0.01}, kSetting);
    tap.start({});
    FieldState state;
    const SurfaceTouch above{Vector3d::UnitY(), 0.0, speed};
    const SurfaceTouch within{Vector3d::UnitY(), 1.0, speed};
    EXPECT_EQ(tap.force({{}, 0.1, &above}, state).norm(), 0.0);
    tap.force({{}, 0.2, &within}, state);
    return tap.force({{}, 0.20125, &within}, state).y();
  };
  EXPECT_NEAR(strength(0.1), 10.0 * 0.1 * std::exp(-0.125), 1e-9);
  EXPECT_NEAR(strength(0.2), 2.0 * strength(0.1), 1e-12);
}

// --- detent, click, mover ---------------------------------------------------------------------

TEST(DetentTest, RestsAtItsPlacesAndPullsBetweenThem) {
  Detent detent({{0.01, 0.0, 0.0}, {2.0, 0.0, 0.0}, 0.004, 1.5, 3}, kSetting);
  FieldState state;
  const auto force = [&](double s) {
    return detent.force(at_place({0.01 + s, 0.3, 0.0}), state).x();
  };
  for (const double s : {0.0, 0.004, 0.008}) {
    EXPECT_NEAR(force(s), 0.0, 1e-12);
    EXPECT_NEAR(force(s + 0.001), -1.5, 1e-12) << "a quarter further the peak pulls back";
    EXPECT_NEAR(force(s - 0.001), 1.5, 1e-12);
  }
  EXPECT_NEAR(force(0.011), 0.0, 1e-9) << "beyond the last";
  EXPECT_NEAR(force(-0.003), 0.0, 1e-9);
}

TEST(ClickTest, RisesDropsAndStays) {
  Click click({kOrigin, {0.0, -1.0, 0.0}, 2.0, 0.003, 1.2, 0.001}, kSetting);
  FieldState state;
  const auto force = [&](double d) { return click.force(at_place({0.2, -d, 0.0}), state).y(); };
  EXPECT_EQ(force(-0.001), 0.0);
  EXPECT_NEAR(force(0.0015), 1.0, 1e-12);
  EXPECT_NEAR(force(0.003), 2.0, 1e-12);
  EXPECT_NEAR(force(0.0035), 1.4, 1e-12);
  EXPECT_FALSE(state.done);
  EXPECT_NEAR(force(0.0041), 0.8, 1e-12);
  EXPECT_TRUE(state.done);
}

TEST(MoverTest, LeadsAHandFromWhereItIsToThePlaceInTime) {
  Mover mover({{0.05, 0.0, 0.02}, 0.8, {300.0, 20.0}}, kSetting);
  PointState hand{{-0.03, 0.01, 0.0}, Vector3d::Zero()};
  mover.start(hand);
  FieldState state;
  EXPECT_NEAR(mover.force({hand, 0.0, nullptr}, state).norm(), 0.0, 1e-12) << "starts gently";
  for (int i = 0; i < 1000; ++i) {
    const Vector3d force = mover.force({hand, i * 1e-3, nullptr}, state);
    hand.velocity += 1e-3 * (force - 2.0 * hand.velocity) / 0.3;
    hand.position += 1e-3 * hand.velocity;
  }
  EXPECT_LT((hand.position - Vector3d(0.05, 0.0, 0.02)).norm(), 0.001);
  EXPECT_TRUE(state.done);
}

TEST(MoverTest, AHandThatIsThereAlreadyIsHeld) {
  Mover mover({{0.05, 0.0, 0.02}, 0.8, {300.0, 20.0}}, kSetting);
  mover.start({{0.05, 0.0, 0.02}, Vector3d::Zero()});
  FieldState state;
  const Vector3d force = mover.force({{{0.06, 0.0, 0.02}, Vector3d::Zero()}, 0.3, nullptr}, state);
  EXPECT_NEAR(force.x(), -3.0, 1e-12);
}

const std::vector<Vector3d> kCorner{{0.0, 0.0, 0.0}, {0.03, 0.0, 0.0}, {0.03, 0.0, 0.04}};

TEST(PathGuideTest, PullsToAPointThatTravelsAtConstantSpeedAndRests) {
  PathGuide guide({kCorner, 2.0, {900.0, 0.0}}, kSetting);  // 7 cm in 2 s: 35 mm/s
  FieldState state;
  const auto pull = [&](double time) { return guide.force({{}, time, nullptr}, state); };
  const double near = 900.0 * 2e-7;  // chords of 50 µm cut a corner by less
  EXPECT_LT((pull(0.4) - 900.0 * Vector3d(0.014, 0.0, 0.0)).norm(), near);
  EXPECT_LT((pull(1.0) - 900.0 * Vector3d(0.03, 0.0, 0.005)).norm(), near);
  EXPECT_FALSE(state.done);
  EXPECT_LT((pull(2.5) - 900.0 * Vector3d(0.03, 0.0, 0.04)).norm(), near);
  EXPECT_TRUE(state.done);
  EXPECT_NEAR(state.depth, 0.05, 1e-9);
}

/// On the path itself only the damper is felt: b times the speed that the point has over the hand.
TEST(PathGuideTest, TheDamperComesAndGoesWithTheSpeed) {
  const double carried = 1.0;  // N·s/m; the bare handle carries it, so the governor leaves it whole
  const std::vector<Vector3d> line{{0.0, 0.0, 0.0}, {0.07, 0.0, 0.0}};
  PathGuide guide({line, 2.0, {900.0, carried}}, kSetting);
  FieldState state;
  const auto on_path = [&](double time) {
    return guide.force({{{0.035 * time, 0.0, 0.0}, Vector3d::Zero()}, time, nullptr}, state).x();
  };
  EXPECT_NEAR(on_path(0.0), 0.0, 1e-12);
  EXPECT_NEAR(on_path(0.04), 0.5 * 0.035, 0.03 * 0.035);
  EXPECT_NEAR(on_path(1.0), 0.035, 1e-9);
  EXPECT_NEAR(on_path(1.96), 0.5 * 0.035, 0.03 * 0.035);
  EXPECT_NEAR(on_path(2.0), 0.0, 1e-12);
}

/// The gains of the force study round a square, back along a line, and there faster: a hand that
/// rests feels the spring's pull and the damper's go on without a step.
TEST(PathGuideTest, TheForceDoesNotJumpAtACorner) {
  const std::vector<Vector3d> square{
      kOrigin, {0.03, 0.0, 0.0}, {0.03, 0.0, 0.03}, {0.0, 0.0, 0.03}, kOrigin};
  const std::vector<Vector3d> back_and_forth{
      kOrigin, {0.03, 0.0, 0.0}, {-0.03, 0.0, 0.0}, {0.03, 0.0, 0.0}};
  for (const PathParameters& p : {PathParameters{square, 4.0, {900.0, 100.0}},
                                  PathParameters{back_and_forth, 1.5, {300.0, 40.0}},
                                  PathParameters{kCorner, 0.05, {0.0, 20.0}}}) {
    PathGuide guide(p, kSetting);
    FieldState state;
    double length = 0.0;
    for (std::size_t i = 1; i < p.points.size(); ++i) {
      length += (p.points[i] - p.points[i - 1]).norm();
    }
    const double speed = length / p.duration;
    // At the fastest the velocity turns round, by twice its size, while the mean passes a corner.
    const double passes = 0.08 / (1.0 + 0.08 / p.duration);  // [s]
    const double most = 1.001e-3 * speed * (p.gains.stiffness + 2.0 * p.gains.damping / passes);
    Vector3d before = Vector3d::Zero();
    for (int i = 0; 1e-3 * i < p.duration + 0.2; ++i) {
      const Vector3d force = guide.force({{}, 1e-3 * i, nullptr}, state);
      ASSERT_LT((force - before).norm(), most) << p.duration << " s, tick " << i;
      before = force;
    }
  }
}

/// A mass with the hand's damping, led by the study's gains.
TEST(PathGuideTest, LeadsAHandAlongThePath) {
  PathGuide guide({kCorner, 4.0, {900.0, 100.0}}, kSetting);
  PointState hand;
  FieldState state;
  double worst = 0.0;
  for (int i = 0; i < 4500; ++i) {
    const Vector3d force = guide.force({hand, i * 1e-3, nullptr}, state);
    hand.velocity += 1e-3 * (force - 15.0 * hand.velocity) / 1.0;
    hand.position += 1e-3 * hand.velocity;
    worst = std::max(worst, state.depth);
  }
  EXPECT_LT((hand.position - kCorner.back()).norm(), 2e-4);
  EXPECT_LT(worst, 0.002);
}

TEST(CurveHoldTest, PullsAcrossTheCurveAndLeavesTheHandFreeAlongIt) {
  CurveHold hold({kCorner, {900.0, 10.0}}, kSetting);
  FieldState state;
  const PointState hand{{0.01, 0.002, 0.0}, {0.3, 0.0, 0.1}};
  hold.start(hand);
  const Vector3d force = hold.force({hand, 0.0, nullptr}, state);
  EXPECT_LT((force - Vector3d(0.0, -900.0 * 0.002, -10.0 * 0.1)).norm(), 1e-9);
  EXPECT_NEAR(state.depth, 0.002, 1e-12);
}

/// A curve that nearly closes: the hand goes round it, and what follows in another trial of the
/// same curve goes on at its strand, though the other one is nearer.
TEST(CurveHoldTest, InsideOfACornerTheForceTurnsByDegrees) {
  const double slope = std::tan(std::numbers::pi / 6.0);  // 120 degrees at the origin
  const std::vector<Vector3d> corner{{-0.05, 0.05 * slope, 0.0}, {}, {0.05, 0.05 * slope, 0.0}};
  CurveHold hold({corner, {900.0, 10.0}}, kSetting);
  const Vector3d from(-0.01, 0.0025, 0.0);
  hold.start({from, Vector3d::Zero()});
  constexpr double kSpeed = 0.05;  // [m/s]
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i < 400; ++i) {
    const PointState hand{from + Vector3d(kSpeed * i / kSetting.rate, 0.0, 0.0),
                          {kSpeed, 0.0, 0.0}};
    FieldState state;
    Felt felt;
    felt.hand = hand;
    const Vector3d force = hold.force(felt, state);
    if (i > 0) {
      const double way = kSpeed / kSetting.rate;
      const double allowed = 900.0 * way + 10.0 * kSpeed * way / 0.001 + 0.2;
      ASSERT_LE((force - before).norm(), allowed + 1e-9) << i;
    }
    before = force;
  }
  EXPECT_LT(before.x(), 0.0) << "it is drawn back to the other strand";
}

TEST(CurveHoldTest, KeepsItsStrandFromTrialToTrial) {
  const std::vector<Vector3d> hairpin{
      {0.0, 0.0, 0.0}, {0.05, 0.0, 0.0}, {0.05, 0.0, 0.01}, {0.0, 0.0, 0.01}};
  CurveHold hold({hairpin, {900.0, 0.0}}, kSetting);
  FieldState state;
  hold.start({{0.02, 0.0, 0.001}, Vector3d::Zero()});
  const PointState strayed{{0.02, 0.0, 0.007}, Vector3d::Zero()};
  EXPECT_NEAR(hold.force({strayed, 0.0, nullptr}, state).z(), -900.0 * 0.007, 1e-9);
  CurveHold next({hairpin, {900.0, 0.0}}, kSetting);
  next.adopt(hold);
  EXPECT_NEAR(next.force({strayed, 0.0, nullptr}, state).z(), -900.0 * 0.007, 1e-9);
  CurveHold other({{{0.0, 0.0, 0.02}, {0.05, 0.0, 0.02}}, {900.0, 0.0}}, kSetting);
  other.adopt(next);
  EXPECT_NEAR(other.force({strayed, 0.0, nullptr}, state).z(), 900.0 * 0.013, 1e-9);
}

TEST(CurveHoldTest, RefusesWhatIsNoCurve) {
  const auto told = [](auto law) { return test::message_of<std::invalid_argument>(law); };
  EXPECT_THAT(told([] { CurveHold({{kOrigin}, {900.0, 10.0}}, kSetting); }), HasSubstr("points"));
  EXPECT_THAT(told([] { CurveHold({kCorner, {-1.0, 10.0}}, kSetting); }), HasSubstr("stiffness"));
}

TEST(FieldTest, BadParametersAreNamed) {
  const auto told = [](auto law) { return test::message_of<std::invalid_argument>(law); };
  EXPECT_THAT(told([] { Ramp({kOrigin, kOrigin, 0.0}, kSetting); }), HasSubstr("rise"));
  EXPECT_THAT(told([] { Pulse({kOrigin, 0.0, 0.1, 0.06}, kSetting); }), HasSubstr("rise"));
  EXPECT_THAT(told([] { Inertia({-1.0, 20.0}, kSetting); }), HasSubstr("mass"));
  EXPECT_THAT(told([] { Friction({"", 0.4, 0.5}, kSetting); }), HasSubstr("static_level"));
  EXPECT_THAT(told([] {
                SineVibration({Vector3d::UnitX(), 1.0, 500.0}, kSetting);
              }),
              HasSubstr("frequency"));
  EXPECT_THAT(told([] {
                Detent({kOrigin, Vector3d::UnitX(), 0.01, 11.0}, kSetting);
              }),
              HasSubstr("peak"));
  EXPECT_THAT(told([] {
                Click({kOrigin, Vector3d::UnitX(), 1.0, 0.01, 2.0}, kSetting);
              }),
              HasSubstr("drop"));
  EXPECT_THAT(told([] { Mover({kOrigin, 0.0}, kSetting); }), HasSubstr("duration"));
  EXPECT_THAT(told([] {
                largest_stable_mass(20.0, {0.2, 1000.0, 1, 0});
              }),
              HasSubstr("velocity_window"));
}

TEST(PathGuideTest, RefusesWhatIsNoPath) {
  const auto told = [](auto law) { return test::message_of<std::invalid_argument>(law); };
  EXPECT_THAT(told([] { PathGuide({{kOrigin, kOrigin}, 1.0}, kSetting); }), HasSubstr("points"));
  EXPECT_THAT(told([] { PathGuide({kCorner, 0.0}, kSetting); }), HasSubstr("duration"));
  EXPECT_THAT(told([] {
                PathGuide({kCorner, 1.0, {-1.0, 0.0}}, kSetting);
              }),
              HasSubstr("stiffness"));
}

}  // namespace
}  // namespace haptrial::scene
