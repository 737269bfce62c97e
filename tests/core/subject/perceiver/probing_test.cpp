#include "core/subject/perceiver/probing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/core/subject/perceiver/hand_rig.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::subject {
namespace {

using test::field;
using test::floor_of;
using test::HandRig;
using test::kStep;
using test::Vector3d;
using testing::HasSubstr;

constexpr double kFriction = 0.1;  // of the handle, HandParameters [N]

TEST(ProberTest, APressSettlesWhereTheWallCarriesItsForce) {
  for (const double stiffness : {150.0, 300.0, 1000.0}) {
    HandRig rig({floor_of(stiffness)}, {0.0, 0.005, 0.0});
    // The hand's posture yields with (b + k tau) / K, 0.43 s in the softest wall.
    rig.run(Press{{0.0, -1.0, 0.0}, 3.0, 0.5}, 6.0);
    // Coulomb friction may carry its share of the force.
    EXPECT_NEAR(-rig.read().position.y(), 3.0 / stiffness, kFriction / stiffness + 2e-5)
        << stiffness;
    EXPECT_NEAR(rig.read().position.x(), 0.0, 1e-4);
  }
}

TEST(ProberTest, APressRisesSlowly) {
  HandRig rig({floor_of(300.0)});
  double steepest = 0.0;
  double last = 0.0;
  double highest = 0.0;
  rig.run(Press{{0.0, -1.0, 0.0}, 3.0, 0.5}, 3.0, [&](double, const Vector3d& f, const auto&) {
    steepest = std::max(steepest, std::abs(f.y() - last) / kStep);
    highest = std::max(highest, f.y());
    last = f.y();
  });
  // The minimum-jerk rise has 1.875 F / T = 11.25 N/s; quantised readings add 3 N/s a tick.
  EXPECT_LT(steepest, 2.0 * 11.25);
  EXPECT_LT(highest, 1.1 * 3.0) << "hardly overshoots";
}

TEST(ProberTest, APressAlongAnyDirectionIntoASpring) {
  const Vector3d direction = Vector3d(1.0, -1.0, 0.5).normalized();
  HandRig rig({field("spring", scene::SpringParameters{Vector3d::Zero(), {250.0, 3.0}})});
  rig.run(Press{2.0 * direction, 2.5, 0.5}, 3.0);
  // Feedback across the push holds the place; along it the spring carries the force.
  EXPECT_NEAR(rig.read().position.dot(direction), 0.01, 2.0 * kFriction / 250.0);
  EXPECT_LT((rig.read().position - 0.01 * direction).norm(), 1e-3);
}

TEST(ProberTest, APressIntoNothingEndsAtItsTravel) {
  HandRig rig;
  rig.run(Press{{0.0, -1.0, 0.0}, 3.0, 0.5, 0.03}, 6.0);
  EXPECT_GT(-rig.read().position.y(), 0.03);
  EXPECT_LT(-rig.read().position.y(), 0.03 + 3.0 / 300.0 + 1e-3);
  EXPECT_LT(rig.read().velocity.norm(), 1e-3);
}

struct Stroked {
  double half_way;  // half of the way from end to end [m]
  double fourier;   // amplitude at the frequency [m]
  double pressing;  // mean force of the floor [N]
};

Stroked stroked(const std::vector<scene::Field>& fields, const Stroke& stroke) {
  HandRig rig(fields, {0.0, 0.002, 0.0});
  rig.run(stroke, 2.0);
  double most = -1.0;
  double least = 1.0;
  double in_phase = 0.0;
  double quadrature = 0.0;
  double pressing = 0.0;
  const double seconds = 4.0;  // whole cycles
  rig.go_on(seconds, [&](double t, const Vector3d& f, const PointState& hand) {
    const double x = hand.position.x();
    most = std::max(most, x);
    least = std::min(least, x);
    const double phase = 2.0 * std::numbers::pi * stroke.frequency * t;
    in_phase += 2.0 * x * std::sin(phase) * kStep / seconds;
    quadrature += 2.0 * x * std::cos(phase) * kStep / seconds;
    pressing += f.y() * kStep / seconds;
  });
  return {0.5 * (most - least), std::hypot(in_phase, quadrature), pressing};
}

TEST(ProberTest, AStrokeHasItsAmplitudeAndFrequency) {
  for (const double frequency : {0.5, 1.0, 2.0}) {
    const Stroked s = stroked({}, {{1.0, 0.0, 0.0}, 0.02, frequency});
    EXPECT_NEAR(s.half_way, 0.02, 0.02 * 0.02) << frequency;
    EXPECT_NEAR(s.fourier, 0.02, 0.02 * 0.02) << frequency;
  }
}

TEST(ProberTest, AStrokePressesAndLosesWhatFrictionTakesFromTheFeedback) {
  const double level = 0.2;
  for (const double frequency : {0.5, 1.0, 2.0}) {
    const Stroked s =
        stroked({floor_of(800.0), field("rub", scene::FrictionParameters{"floor", level, level})},
                {{1.0, 0.0, 0.0}, 0.02, frequency, {0.0, -1.0, 0.0}, 1.0});
    EXPECT_NEAR(s.pressing, 1.0, kFriction + 0.02) << frequency;
    EXPECT_LE(s.half_way, 1.02 * 0.02) << frequency;
    EXPECT_GE(s.half_way, 0.02 - level * s.pressing / 200.0 - 0.02 * 0.02) << "kp is 200 N/m";
  }
}

TEST(ProberTest, AStrokeAndAPalpationThatPressIntoNothingEndAsAPressDoes) {
  const Vector3d down(0.0, -1.0, 0.0);
  Palpate palpation;
  palpation.places[0] = Vector3d(0.0, -0.01, 0.0);
  palpation.count = 1;
  palpation.force = 2.0;
  palpation.press = 10.0;
  for (const Probe& probe :
       {Probe{Press{down, 2.0, 0.3, 0.05}}, Probe{Stroke{{1.0, 0.0, 0.0}, 0.02, 0.5, down, 2.0}},
        Probe{palpation}}) {
    HandRig rig;
    double deepest = 0.0;
    rig.run(probe, 8.0, [&](double, const auto&, const PointState&) {
      deepest = std::max(deepest, -rig.hand.state().position.y());
    });
    // 2 N against 300 N/m beyond 50 mm, which a palpation counts from its place.
    EXPECT_GT(deepest, 0.05) << probe.index();
    EXPECT_LT(deepest, 0.07) << probe.index();
  }
}

TEST(ProberTest, AReachIsStraightBellShapedAndThere) {
  for (const double duration : {0.35, 0.5, 0.8}) {
    const Vector3d to(0.04, 0.0, -0.05);
    HandRig rig;
    double peak = 0.0;
    double peak_time = 0.0;
    double off = 0.0;
    const Vector3d u = to.normalized();
    rig.run(Reach{to, duration}, duration, [&](double t, const auto&, const PointState&) {
      const PointState hand = rig.hand.state();
      off = std::max(off, (hand.position - hand.position.dot(u) * u).norm());
      if (hand.velocity.norm() > peak) {
        peak = hand.velocity.norm();
        peak_time = t;
      }
    });
    EXPECT_LT((rig.hand.state().position - to).norm(), 0.002) << duration;
    EXPECT_NEAR(peak, 1.875 * to.norm() / duration, 0.05 * peak) << duration;
    EXPECT_NEAR(peak_time, 0.5 * duration, 0.06 * duration) << duration;
    EXPECT_LT(off, 0.002) << duration;
    rig.go_on(0.5);
    EXPECT_LT((rig.hand.state().position - to).norm(), 0.0005) << "keeps the place";
  }
}

TEST(ProberTest, AReachIntoASpringGetsThereInTheEnd) {
  HandRig rig({floor_of(300.0)});
  rig.run(Reach{{0.0, -0.01, 0.0}, 0.6}, 2.0);
  EXPECT_NEAR(rig.read().position.y(), -0.01, kFriction / 300.0)
      << "a push to a depth, but for what the handle's friction carries";
}

TEST(ProberTest, AHandThatHoldsCarriesASteadyLoadAndOneAtRestDoesNot) {
  const auto load = field("load", scene::ConstantParameters{{0.0, 0.0, 2.0}});
  HandRig holding({load});
  holding.run(Hold{}, 2.0);
  EXPECT_LT(holding.read().position.norm(), 5e-4);
  HandRig resting({load});
  resting.run(Rest{}, 0.5);
  EXPECT_GT(resting.read().position.z(), 0.01);
}

TEST(ProberTest, MotorNoiseShakesTheHand) {
  HandRig rig({floor_of(300.0)});
  rig.prober =
      ExplorationController(HandParameters{}, MotorNoise(SubjectParameters{}, kStep, {1, "motor"}));
  double sum = 0.0;
  double squares = 0.0;
  rig.run(Press{{0.0, -1.0, 0.0}, 3.0, 0.5}, 1.0);
  rig.go_on(20.0, [&](double, const Vector3d& f, const auto&) {
    sum += f.y() * kStep / 20.0;
    squares += f.y() * f.y() * kStep / 20.0;
  });
  const double spread = std::sqrt(squares - sum * sum);
  EXPECT_NEAR(sum, 3.0, 0.2);
  // The arm's force has 3 % of 3 N beside tremor; the handle's friction takes some of it.
  EXPECT_GT(spread, 0.01);
  EXPECT_LT(spread, 0.2);
}

TEST(ProberTest, BadProbesAreNamed) {
  const auto message = [](const Probe& probe) {
    return haptrial::test::message_of<std::invalid_argument>([&] { check(probe); });
  };
  EXPECT_THAT(message(Press{Vector3d::Zero()}), HasSubstr("press: direction"));
  EXPECT_THAT(message(Press{{0, 1, 0}, -1.0}), HasSubstr("press: force"));
  EXPECT_THAT(message(Press{{0, 1, 0}, 1.0, 0.0}), HasSubstr("press: rise"));
  EXPECT_THAT(message(Press{{0, 1, 0}, 1.0, 0.1, 0.0}), HasSubstr("press: travel"));
  EXPECT_THAT(message(Stroke{{1, 0, 0}, 0.0}), HasSubstr("half_length"));
  EXPECT_THAT(message(Stroke{{1, 0, 0}, 0.1, 0.0}), HasSubstr("frequency"));
  EXPECT_THAT(message(Stroke{{1, 0, 0}, 0.1, 1.0, {2, 0, 0}}), HasSubstr("normal"));
  EXPECT_THAT(message(Stroke{{1, 0, 0}, 0.1, 1.0, {0, 1, 0}, NAN}), HasSubstr("stroke: force"));
  EXPECT_THAT(message(Reach{{NAN, 0, 0}}), HasSubstr("reach: to"));
  EXPECT_THAT(message(Reach{{0, 0, 0}, 0.0}), HasSubstr("duration"));
  for (const Probe& good :
       {Probe{Rest{}}, Probe{Hold{}}, Probe{Press{}}, Probe{Stroke{}}, Probe{Reach{}}}) {
    EXPECT_EQ(message(good), "nothing was thrown");
  }
}

TEST(ProberTest, DoesNotAllocate) {
  ExplorationController prober(HandParameters{},
                               MotorNoise(SubjectParameters{}, kStep, {1, "motor"}));
  PointState hand;
  double sum = 0.0;
  const haptrial::test::AllocationGuard guard;
  for (const Probe& probe :
       {Probe{Rest{}}, Probe{Hold{}}, Probe{Press{}},
        Probe{Stroke{{1, 0, 0}, 0.02, 0.5, {0, -1, 0}, 1.0}}, Probe{Reach{{0.01, 0.0, 0.0}}}}) {
    prober.begin(probe, hand);
    for (int i = 0; i < 1000; ++i) {
      sum += prober.command(hand, kStep).force.norm();
    }
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace haptrial::subject
