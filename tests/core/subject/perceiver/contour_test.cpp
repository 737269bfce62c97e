#include "core/subject/perceiver/contour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/geometry/mesh/procedural.h"
#include "core/subject/perceiver/contact_episodes.h"
#include "tests/core/subject/perceiver/hand_rig.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject {
namespace {

using test::field;
using test::HandRig;
using test::kStep;
using test::Vector3d;

scene::Field solid(geometry::Mesh mesh) {
  scene::RigidObjectParameters p;
  p.body = std::make_shared<const contact::FeltBody>(std::move(mesh));
  p.gains = {600.0, 1.0};
  p.friction = {0.2, 0.15};
  return field("thing", std::move(p));
}

/// How far round an axis the hand has gone, and how long it touched.
struct Round {
  double turns{0.0};
  double touched{0.0};  // share of the time
  ContactEpisodes met{SenseParameters{}};
};

Round explored(geometry::Mesh mesh, const Contour& contour, double seconds) {
  HandRig rig({solid(std::move(mesh))}, {0.0, 0.045, 0.0});
  Round round;
  Vector3d before = Vector3d::Zero();
  int ticks = 0;
  rig.run(contour, seconds, [&](double, const Vector3d& force, const PointState& hand) {
    round.met.feel(force, hand, kStep);
    round.touched += force.norm() > 0.0 ? 1.0 : 0.0;
    ++ticks;
    if (!before.isZero()) {
      const double turn =
          std::atan2(before.x() * hand.position.y() - before.y() * hand.position.x(),
                     before.x() * hand.position.x() + before.y() * hand.position.y());
      round.turns += turn / (2.0 * std::numbers::pi);
    }
    before = hand.position;
  });
  round.touched /= ticks;
  return round;
}

Contour about_z() {
  Contour contour;
  contour.turn_after = 100.0;
  return contour;
}

TEST(ContourTest, TheHandGoesRoundASphereAtItsSpeed) {
  const Round round = explored(geometry::make_sphere(0.025, 24), about_z(), 10.0);
  // 0.4 s to get there; the hand presses in by a millimetre.
  EXPECT_NEAR(round.turns, 9.6 * 0.05 / (2.0 * std::numbers::pi * 0.024), 0.5);
  EXPECT_GT(round.touched, 0.9);
}

TEST(ContourTest, TheHandFindsItsWayRoundTheEdgesOfACube) {
  const Round round = explored(geometry::make_box({0.04, 0.04, 0.04}), about_z(), 12.0);
  EXPECT_GT(round.turns, 1.9);
  EXPECT_GT(round.touched, 0.6);
}

/// A square of side a has the radial distances a/2 / cos(angle): rms 0.058 a about their mean.
TEST(ContourTest, ACubeIsUnevenAndASphereIsNot) {
  const Contour both{.turn_after = 5.0};
  const double cube = explored(geometry::make_box({0.04, 0.04, 0.04}), both, 10.0).met.unevenness();
  const double sphere = explored(geometry::make_sphere(0.025, 24), both, 10.0).met.unevenness();
  EXPECT_GT(cube, 0.04 * 0.04);
  EXPECT_LT(sphere, 0.0015);
  EXPECT_GT(cube, 1.4 * sphere);
}

/// Places on known curves, touched at an even speed.
TEST(ContourTest, UnevennessIsTheRadialDeviation) {
  const auto of = [](auto radius) {
    ContactEpisodes met{SenseParameters{}};
    met.begin();
    const Vector3d centre(0.02, -0.01, 0.05);
    for (int i = 0; i < 20000; ++i) {
      const double a = 1e-3 * i, tilt = 0.37e-3 * i;
      const Vector3d out(std::cos(a) * std::cos(tilt), std::sin(a) * std::cos(tilt),
                         std::sin(tilt));
      PointState hand;
      hand.position = centre + radius(a) * out;
      hand.velocity = {0.05, 0.0, 0.0};
      met.feel(out, hand, kStep);
    }
    return met.unevenness();
  };
  EXPECT_LT(of([](double) { return 0.025; }), 2e-5);
  const double waves = of([](double a) { return 0.025 + 0.001 * std::sin(5.0 * a); });
  EXPECT_NEAR(waves, 0.001 / std::numbers::sqrt2, 0.03 * 0.001);
}

TEST(ContourTest, AHandThatFindsNothingGoesOnForTenCentimetres) {
  HandRig rig({}, {0.0, 0.045, 0.0});
  rig.run(about_z(), 1.0);
  EXPECT_NEAR(rig.read().position.y(), 0.045 - 0.05, 0.01);
  rig.go_on(4.0);
  EXPECT_NEAR(rig.read().position.y(), 0.045 - 0.1, 0.01);
}

TEST(ContourTest, ATickAllocatesNothing) {
  ContourFollower follower;
  const haptrial::test::AllocationGuard guard;
  follower.begin(Contour{}, Vector3d::Zero());
  for (int i = 0; i < 8000; ++i) {
    follower.step(kStep * i, {}, (i / 500) % 2 == 0 ? Vector3d(0.0, 1.0, 0.0) : Vector3d::Zero(),
                  kStep);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::subject
