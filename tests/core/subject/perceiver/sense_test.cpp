#include "core/subject/perceiver/sense.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/subject/perceiver/trial_stream.h"
#include "tests/core/subject/perceiver/hand_rig.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::subject::sense_test {
namespace {

using test::field;
using test::floor_of;
using test::HandRig;
using test::kStep;
using test::Vector3d;
using testing::HasSubstr;

const Vector3d kDown(0.0, -1.0, 0.0);
constexpr int kIntervals = 4000;
const double kFourSigma = 4.0 / std::sqrt(2.0 * kIntervals);  // of an estimated spread, relative

SenseParameters noiseless() {
  SenseParameters s;
  s.force_weber = s.force_floor = s.displacement_weber = s.speed_weber = s.extent_weber = 0.0;
  return s;
}

double percept(const SenseParameters& senses, Quantity quantity,
               const std::vector<scene::Field>& fields, const Probe& probe) {
  HandRig rig(fields);
  Sense sense(senses, quantity);
  RandomStream random(1, "sense");
  sense.begin(random);
  rig.run(probe, 2.5, [&](double, const Vector3d& force, const PointState& hand) {
    sense.feel(force, hand, kStep);
  });
  return sense.percept();
}

/// sd of the log of the percept over intervals that are alike but for the senses.
double log_spread(const SenseParameters& senses, Quantity quantity, const ContactEpisode& met) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kIntervals; ++i) {
    RandomStream random = trial_stream(7, "sense", i);
    const double x = std::log(felt(senses, quantity, met, draw_noise(random)));
    sum += x / kIntervals;
    squares += x * x / kIntervals;
  }
  return std::sqrt(squares - sum * sum);
}

/// The Weber fraction of a quantity: spread of the log of the percept over how much the log of the
/// percept changes with that of the level, both through the hand.
double weber(Quantity quantity, double level, const std::function<scene::Field(double)>& stimulus,
             const std::function<Probe(double)>& probe) {
  const double change =
      std::log(percept(noiseless(), quantity, {stimulus(1.1 * level)}, probe(1.1 * level)) /
               percept(noiseless(), quantity, {stimulus(level)}, probe(level))) /
      std::log(1.1);
  HandRig rig({stimulus(level)});
  Sense sense(SenseParameters{}, quantity);
  RandomStream random(1, "sense");
  sense.begin(random);
  rig.run(probe(level), 2.5, [&](double, const Vector3d& force, const PointState& hand) {
    sense.feel(force, hand, kStep);
  });
  return log_spread(SenseParameters{}, quantity, sense.met()) / std::abs(change);
}

TEST(SenseTest, OneModelGivesTheFractionsOfForceStiffnessAndCompliance) {
  const SenseParameters defaults;
  const auto load = [](double level) {
    return field("load", scene::ConstantParameters{{0.0, level, 0.0}});
  };
  const auto hold = [](double) { return Probe{Hold{}}; };
  const auto wall = [](double level) { return floor_of(level); };
  const auto soft = [](double level) { return floor_of(1.0 / level); };
  const auto press = [](double) { return Probe{Press{kDown, 3.0, 0.5}}; };
  const auto push = [](double) { return Probe{Reach{{0.0, -0.01, 0.0}, 0.6}}; };

  const double force = weber(Quantity::kForce, 3.0, load, hold);
  EXPECT_NEAR(force, 0.07, 0.07 * kFourSigma + 0.0005) << "Pang, Tan and Durlach: 5 to 10 %";
  const double fixed = weber(Quantity::kStiffness, 300.0, wall, push);
  EXPECT_NEAR(fixed, force, 0.03 * force) << "with a fixed deflection that of force";
  const double pressed = weber(Quantity::kStiffness, 300.0, wall, press);
  EXPECT_NEAR(pressed, force / (1.0 - defaults.displacement_bias), 0.05 * pressed);
  const double compliance = weber(Quantity::kCompliance, 1.0 / 300.0, soft, press);
  EXPECT_NEAR(compliance, 0.15, 0.01);
  RecordProperty("force", std::to_string(force));
  RecordProperty("stiffness_at_a_fixed_deflection", std::to_string(fixed));
  RecordProperty("stiffness_pressed", std::to_string(pressed));
  RecordProperty("compliance", std::to_string(compliance));
}

TEST(SenseTest, ViscosityFrictionAndExtentHaveTheirFractions) {
  const SenseParameters s;
  EXPECT_NEAR(log_spread(s, Quantity::kViscosity, {10.0, 1.0}),
              std::sqrt(0.07 * 0.07 + 0.02 * 0.02 + 0.23 * 0.23), 0.24 * kFourSigma + 1e-3);
  // 19 % at 71 % correct (Jones, Hunter and Lafontaine 1997): d' = sqrt(2) Phi^-1(0.71) = 0.783.
  EXPECT_NEAR(0.783 * log_spread(s, Quantity::kViscosity, {10.0, 3.0}), 0.19, 0.01);
  EXPECT_NEAR(log_spread(s, Quantity::kFriction, {2.0, 2.0}), 0.0707, 0.005);
  EXPECT_NEAR(log_spread(s, Quantity::kExtent, {0.04, 0.0}), 0.10, 0.10 * kFourSigma);
}

TEST(SenseTest, NearNothingTheFloorDecides) {
  const SenseParameters s;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kIntervals; ++i) {
    RandomStream random = trial_stream(3, "sense", i);
    const double x = felt(s, Quantity::kForce, {0.0, 0.0}, draw_noise(random));
    sum += x / kIntervals;
    squares += x * x / kIntervals;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 * s.force_floor / std::sqrt(kIntervals));
  EXPECT_NEAR(std::sqrt(squares), s.force_floor, s.force_floor * kFourSigma);
}

TEST(SenseTest, TheUsualDeflectionIsFeltAsItIs) {
  const SenseParameters s = noiseless();
  EXPECT_NEAR(felt(s, Quantity::kStiffness, {300.0, 3.0}, {}), 300.0, 1e-9);
  EXPECT_NEAR(felt(s, Quantity::kCompliance, {300.0, 3.0}, {}), 1.0 / 300.0, 1e-12);
  EXPECT_NEAR(felt(s, Quantity::kStiffness, {600.0, 3.0}, {}), 300.0 * std::pow(2.0, 0.47), 1e-9);
  EXPECT_NEAR(felt(s, Quantity::kStiffness, {600.0, 6.0}, {}), 600.0, 1e-9);
}

TEST(SenseTest, FreeAirIsSoftWithoutEnd) {
  EXPECT_EQ(felt({}, Quantity::kStiffness, {}, {}), 0.0);
  EXPECT_EQ(felt({}, Quantity::kCompliance, {}, {}), std::numeric_limits<double>::infinity());
}

TEST(SenseTest, NoiseIsThatOfTheInterval) {
  Sense sense(SenseParameters{}, Quantity::kForce);
  const auto feel = [&] {
    for (int i = 0; i < 100; ++i) {
      sense.feel({0.0, 2.0, 0.0}, PointState{}, kStep);
    }
    return sense.percept();
  };
  RandomStream random = trial_stream(5, "sense", 12);
  sense.begin(random);
  const double first = feel();
  EXPECT_NEAR(feel(), first, 1e-12) << "constant within an interval";
  sense.begin(random);
  EXPECT_NE(feel(), first) << "another interval";
  random = trial_stream(5, "sense", 12);
  sense.begin(random);
  EXPECT_EQ(feel(), first) << "the same trial again";
}

TEST(SenseTest, BadParametersAreNamed) {
  const auto message = [](double SenseParameters::*field, double value) {
    SenseParameters s;
    s.*field = value;
    return haptrial::test::message_of<std::invalid_argument>([&] { Sense(s, Quantity::kForce); });
  };
  EXPECT_THAT(message(&SenseParameters::force_weber, -0.1), HasSubstr("force_weber"));
  EXPECT_THAT(message(&SenseParameters::force_floor, NAN), HasSubstr("force_floor"));
  EXPECT_THAT(message(&SenseParameters::displacement_bias, 1.0), HasSubstr("displacement_bias"));
  EXPECT_THAT(message(&SenseParameters::displacement_weber, -1.0), HasSubstr("displacement_weber"));
  EXPECT_THAT(message(&SenseParameters::speed_weber, INFINITY), HasSubstr("speed_weber"));
  EXPECT_THAT(message(&SenseParameters::extent_weber, -1.0), HasSubstr("extent_weber"));
  EXPECT_THAT(message(&SenseParameters::usual_deflection, 0.0), HasSubstr("usual_deflection"));
  EXPECT_THAT(message(&SenseParameters::contact_force, -1.0), HasSubstr("contact_force"));
  EXPECT_THAT(message(&SenseParameters::moving_speed, 0.0), HasSubstr("moving_speed"));
}

TEST(SenseTest, DoesNotAllocate) {
  Sense sense(SenseParameters{}, Quantity::kStiffness);
  double sum = 0.0;
  const haptrial::test::AllocationGuard guard;
  RandomStream random = trial_stream(5, "sense of the hand", 1234567);
  sense.begin(random);
  for (int i = 0; i < 1000; ++i) {
    PointState hand;
    hand.position.y() = -1e-5 * i;
    hand.velocity.y() = -0.01;
    sense.feel({0.0, 3e-3 * i, 0.0}, hand, kStep);
    sum += sense.percept();
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace haptrial::subject::sense_test
