#include "core/subject/perceiver/contact_episodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/subject/perceiver/hand_rig.h"

namespace haptrial::subject::encounters_test {
namespace {

using test::field;
using test::floor_of;
using test::HandRig;
using test::kStep;
using test::Vector3d;

const Vector3d kDown(0.0, -1.0, 0.0);

/// Contacts of a probe in a scene.
ContactEpisodes explore(const std::vector<scene::Field>& fields, const Probe& probe, double seconds,
                        const Vector3d& start = Vector3d::Zero()) {
  HandRig rig(fields, start);
  ContactEpisodes met(SenseParameters{});
  rig.run(probe, seconds, [&](double, const Vector3d& force, const PointState& hand) {
    met.feel(force, hand, kStep);
  });
  return met;
}

TEST(UpperMeanTest, ASteadySignalComesOutExactlyAndTheLowerHalfOfTheTimeDoesNotCount) {
  UpperMean mean;
  EXPECT_EQ(mean.mean(), 0.0);
  for (const double value : {0.0, 1e-5, 0.37, 3.0, 999.0}) {
    mean.clear();
    for (int i = 0; i < 100; ++i) {
      mean.add(value, kStep);
    }
    EXPECT_NEAR(mean.mean(), value, 1e-12 * value);
  }
  mean.clear();
  for (int i = 0; i < 100; ++i) {
    mean.add(i < 49 ? 0.01 * i : 3.0, kStep);
  }
  EXPECT_NEAR(mean.mean(), 3.0, 1e-12);
}

TEST(UpperMeanTest, OfARampItIsThreeQuarters) {
  UpperMean mean;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    mean.add(8.0 * (i + 0.5) / kCount, kStep);
  }
  EXPECT_NEAR(mean.mean(), 6.0, 0.005 * 6.0) << "uniform on 0 to 8: the mean of 4 to 8";
}

/// Three presses on springs, one after the other.
TEST(ContactEpisodesTest, ContrastIsTheStiffestOverTheMedian) {
  ContactEpisodes met(SenseParameters{});
  EXPECT_EQ(met.contrast(), 1.0);
  const auto press = [&](double stiffness) {
    for (int i = 0; i < 400; ++i) {
      const double depth = i < 300 ? 0.005 * std::sin(std::numbers::pi * i / 300.0) : 0.0;
      PointState hand;
      hand.position = {0.0, -depth, 0.0};
      met.feel({0.0, stiffness * depth, 0.0}, hand, kStep);
    }
  };
  press(200.0);
  EXPECT_EQ(met.contrast(), 1.0);
  press(100.0);
  EXPECT_NEAR(met.contrast(), 200.0 / 150.0, 1e-6);
  press(100.0);
  EXPECT_NEAR(met.contrast(), 2.0, 1e-6);
  EXPECT_EQ(met.met(Quantity::kContrast).amount, met.contrast());
}

TEST(ContactEpisodesTest, AWallHasItsStiffnessAndTheForceOfThePress) {
  for (const double stiffness : {150.0, 300.0, 600.0}) {
    const ContactEpisodes met =
        explore({floor_of(stiffness, 0.0)}, Press{kDown, 3.0, 0.5}, 6.0, {0.0, 0.01, 0.0});
    EXPECT_NEAR(met.stiffness(), stiffness, 0.005 * stiffness);
    EXPECT_NEAR(met.force(), 3.0, 0.1 + 0.01) << "but for the handle's friction, 0.1 N";
    // A damper adds force while the hand comes in, where the wall itself has none yet.
    const ContactEpisodes damped =
        explore({floor_of(stiffness, 2.0)}, Press{kDown, 3.0, 0.5}, 2.5, {0.0, 0.01, 0.0});
    EXPECT_NEAR(damped.stiffness(), stiffness, 0.05 * stiffness);
  }
}

TEST(ContactEpisodesTest, ATiltedWallAndASpringToo) {
  const Vector3d normal = Vector3d(0.3, 1.0, -0.2).normalized();
  const auto tilted =
      field("floor",
            scene::SurfaceParameters{scene::HalfSpace{Vector3d::Zero(), normal}, false, {300, 2}});
  EXPECT_NEAR(explore({tilted}, Press{-normal, 3.0, 0.5}, 2.5).stiffness(), 300.0, 9.0);
  const auto spring = field("spring", scene::SpringParameters{Vector3d::Zero(), {200.0, 1.0}});
  EXPECT_NEAR(explore({spring}, Stroke{{0.0, 0.0, 1.0}, 0.015, 0.7}, 3.0).stiffness(), 200.0, 6.0)
      << "to and fro through its rest";
}

TEST(ContactEpisodesTest, AFluidHasItsViscosityAlsoWithFriction) {
  const auto oil = field("oil", scene::ViscousParameters{10.0});
  const Stroke stroke{{1.0, 0.0, 0.0}, 0.03, 0.8};
  EXPECT_NEAR(explore({oil}, stroke, 4.0).viscosity(), 10.0, 0.3);
  const auto dry = field("dry", scene::FrictionParameters{"", 0.5, 0.5, 20000.0});
  const ContactEpisodes both = explore({oil, dry}, stroke, 4.0);
  EXPECT_NEAR(both.viscosity(), 10.0, 0.6) << "the offset of the line takes the friction";
  const auto spring = field("spring", scene::SpringParameters{Vector3d::Zero(), {100.0, 0.0}});
  EXPECT_NEAR(explore({spring}, stroke, 5.0).viscosity(), 0.0, 0.6) << "a spring is no fluid";
}

TEST(ContactEpisodesTest, AnOblongReachThroughACurlFieldMeetsNoResistance) {
  scene::MatrixViscousParameters curl;
  curl.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  const ContactEpisodes met = explore({field("curl", curl)}, Reach{{0.0, 0.0, -0.06}, 0.5}, 0.6);
  EXPECT_NEAR(met.friction(), 0.0, 0.02);
}

TEST(ContactEpisodesTest, FrictionIsTheForceThatResists) {
  const Stroke stroke{{1.0, 0.0, 0.0}, 0.025, 0.5, kDown, 1.5};
  for (const double level : {0.3, 0.6}) {
    HandRig rig(
        {floor_of(800.0), field("rub", scene::FrictionParameters{"floor", level, level, 10000.0})});
    ContactEpisodes met(SenseParameters{});
    double normal = 0.0;
    double way = 0.0;
    rig.run(stroke, 4.0, [&](double, const Vector3d& force, const PointState& hand) {
      met.feel(force, hand, kStep);
      if (hand.velocity.norm() > 0.005) {
        normal += force.y() * std::abs(hand.velocity.x());
        way += std::abs(hand.velocity.x());
      }
    });
    EXPECT_NEAR(normal / way, 1.5, 0.15);
    EXPECT_NEAR(met.friction(), level * normal / way, 0.02 * level * normal / way)
        << "Coulomb: level times normal force; the bristle bends by 0.1 mm at each turn";
  }
  EXPECT_NEAR(explore({floor_of(800.0)}, stroke, 4.0).friction(), 0.0, 0.03) << "a smooth floor";
}

TEST(ContactEpisodesTest, RoughnessIsTheFluctuationOfTheForce) {
  const auto rough = [](double amplitude) {
    scene::GratingParameters grating{"floor", Vector3d::UnitX(), amplitude, 0.002};
    return explore({floor_of(1000.0), field("ridges", grating)},
                   Stroke{{1.0, 0.0, 0.0}, 0.03, 0.5, kDown, 2.0}, 6.0)
        .roughness();
  };
  const double fine = rough(1e-4);
  EXPECT_GT(fine, 5.0 * rough(0.0));
  EXPECT_NEAR(rough(2e-4) / fine, 2.0, 0.3) << "nearly in proportion to the ridges";
}

TEST(ContactEpisodesTest, OfASinusoidRoughnessIsItsRootMeanSquare) {
  ContactEpisodes met(SenseParameters{});
  for (int i = 0; i < 20000; ++i) {
    const double t = i * kStep;
    PointState hand;
    hand.velocity.x() = 0.05;
    met.feel({0.0, 2.0 + 0.3 * std::sin(2.0 * std::numbers::pi * 60.0 * t), 0.0}, hand, kStep);
  }
  // A first-order mean over 50 ms passes 1 / sqrt(1 + (2 pi 60 0.05)^2) = 0.053 of 60 Hz.
  EXPECT_NEAR(met.roughness(), 0.3 / std::numbers::sqrt2, 0.06 * 0.3);
}

TEST(ContactEpisodesTest, AVibrationHasItsFrequencyAtRestAndOnASpring) {
  for (const double frequency : {20.0, 100.0, 250.0}) {
    const auto hum = field("hum", scene::SineVibrationParameters{{0.0, 1.0, 0.0}, 0.3, frequency});
    const ContactEpisodes held = explore({hum}, Rest{}, 2.0);
    EXPECT_NEAR(held.frequency(), frequency, 0.02 * frequency);
    EXPECT_EQ(held.met(Quantity::kFrequency).amount, held.frequency());
    const auto spring = field("spring", scene::SpringParameters{Vector3d::Zero(), {200.0, 1.0}});
    EXPECT_NEAR(explore({hum, spring}, Press{kDown, 1.0, 0.5}, 2.0).frequency(), frequency,
                0.05 * frequency);
  }
  EXPECT_EQ(explore({}, Rest{}, 2.0).frequency(), 0.0);
}

TEST(ContactEpisodesTest, AMassIsFeltByBeingAcceleratedAlsoInOil) {
  const Stroke stroke{{1.0, 0.0, 0.0}, 0.03, 1.5};
  for (const double mass : {0.2, 0.6}) {
    const auto inertia = field("mass", scene::InertiaParameters{mass, 20.0});
    EXPECT_NEAR(explore({inertia}, stroke, 4.0).mass(), mass, 0.06 * mass);
    const auto oil = field("oil", scene::ViscousParameters{5.0});
    EXPECT_NEAR(explore({inertia, oil}, stroke, 4.0).mass(), mass, 0.1 * mass);
  }
  EXPECT_NEAR(explore({}, stroke, 4.0).mass(), 0.0, 1e-9);
}

TEST(ContactEpisodesTest, ADurationIsThatOfTheContact) {
  const auto pulse = field("pulse", scene::PulseParameters{{0.0, 1.0, 0.0}, 0.4, 0.6, 0.05});
  const ContactEpisodes met = explore({pulse}, Rest{}, 2.0);
  EXPECT_NEAR(met.duration(), 0.6, 0.1) << "but for its edges below the contact's force";
  EXPECT_NEAR(explore({}, Rest{}, 2.0).duration(), 2.0, 1e-9);
}

TEST(ContactEpisodesTest, TheExtentIsTheWayBetweenTwoWalls) {
  for (const double gap : {0.03, 0.05}) {
    const auto wall = [&](const char* name, double side) {
      return field(name, scene::SurfaceParameters{
                             scene::HalfSpace{{side * 0.5 * gap, 0.0, 0.0}, {-side, 0.0, 0.0}},
                             false,
                             {1000.0, 5.0}});
    };
    const ContactEpisodes met = explore({wall("left", -1.0), wall("right", 1.0)},
                                        Stroke{{1.0, 0.0, 0.0}, 0.04, 0.5}, 4.0, {0.003, 0.0, 0.0});
    EXPECT_NEAR(met.extent(), gap, 1e-3);
  }
}

TEST(ContactEpisodesTest, WithOneContactTheExtentIsTheWayThereAndWithNoneTheWay) {
  EXPECT_NEAR(explore({floor_of(500.0)}, Press{kDown}, 2.0, {0.0, 0.02, 0.0}).extent(), 0.02, 5e-4);
  EXPECT_NEAR(explore({}, Reach{{0.03, 0.0, 0.0}}, 1.5).extent(), 0.03, 5e-4);
}

TEST(ContactEpisodesTest, InFreeAirNothingIsMet) {
  const ContactEpisodes met = explore({}, Press{kDown, 3.0, 0.5, 0.03}, 2.0);
  for (const Quantity quantity :
       {Quantity::kForce, Quantity::kStiffness, Quantity::kCompliance, Quantity::kViscosity,
        Quantity::kFriction, Quantity::kRoughness}) {
    EXPECT_EQ(met.met(quantity).amount, 0.0);
  }
  EXPECT_EQ(ContactEpisodes(SenseParameters{}).extent(), 0.0);
}

TEST(ContactEpisodesTest, WhatIsNotFiniteIsLeftOutAndBeginForgets) {
  SenseParameters senses;
  senses.contact_force = 0.2;
  ContactEpisodes met(senses);
  PointState hand;
  met.feel({0.0, 2.0, 0.0}, hand, kStep);
  met.feel({0.0, NAN, 0.0}, hand, kStep);
  hand.velocity.x() = INFINITY;
  met.feel({0.0, 1.0, 0.0}, hand, kStep);
  EXPECT_EQ(met.force(), 2.0);
  met.begin();
  EXPECT_EQ(met.force(), 0.0);
  met.feel({0.0, 0.15, 0.0}, PointState{}, kStep);
  EXPECT_EQ(met.force(), 0.0) << "below contact_force";
}

}  // namespace
}  // namespace haptrial::subject::encounters_test
