#include "core/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "tests/core/scene/every_scene.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::scene::scene_test {
namespace {

using Eigen::Vector3d;
using test::field;
using test::kOrigin;
using testing::HasSubstr;

constexpr double kRate = 1000.0;

PointState random_hand(RandomStream& random) {
  const auto three = [&](double size) {
    return Vector3d(random.uniform(-size, size), random.uniform(-size, size),
                    random.uniform(-size, size));
  };
  return {three(0.03), three(0.3)};
}

/// One tick of one field that is wholly on.
Vector3d force_of(const Field& one, const PointState& hand) {
  Scene scene({one}, kRate);
  scene.switch_to(1);
  return scene.force(hand);
}

std::vector<Field> every_kind() {
  MatrixViscousParameters curl;
  curl.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  return {field("rub", FrictionParameters{"floor", 0.6, 0.4}),
          field("push", ConstantParameters{{1.0, 0.0, 0.0}}),
          field("ramp", RampParameters{kOrigin, {1.0, 0.0, 0.0}}),
          field("pulse", PulseParameters{{0.0, 1.0, 0.0}}),
          field("spring", SpringParameters{}),
          field("line", LineChannelParameters{}),
          field("axes", AxisChannelParameters{}),
          field("plane", PlaneParameters{}),
          test::surface(HalfSpace{}),
          field("ridges", GratingParameters{"floor"}),
          field("rough", TextureParameters{"floor"}),
          field("oil", ViscousParameters{}),
          field("curl", curl),
          field("mass", InertiaParameters{}),
          field("dry", FrictionParameters{}),
          field("sine", SineVibrationParameters{}),
          field("noise", NoiseVibrationParameters{}),
          field("tap", TapParameters{"floor"}),
          field("detent", DetentParameters{}),
          field("click", ClickParameters{}),
          field("mover", MoverParameters{}),
          field("path", PathParameters{}),
          field("curve", CurveParameters{}),
          field("ball", SurfaceParameters{Sphere{}})};
}

TEST(SceneTest, ASpringAndAWallHaveTheirClosedForms) {
  const PointState hand{{0.01, -0.004, 0.002}, {0.1, 0.05, -0.2}};
  const Vector3d spring =
      force_of(field("s", SpringParameters{{0.0, 0.02, 0.0}, {150.0, 8.0}}), hand);
  EXPECT_LT((spring - Vector3d(-1.5 - 0.8, 3.6 - 0.4, -0.3 + 1.6)).norm(), 1e-12);
  const Field wall = field("w", SurfaceParameters{HalfSpace{}, false, {300.0, 2.0}});
  const Vector3d pushed = force_of(wall, hand);
  EXPECT_LT((pushed - Vector3d(0.0, 300.0 * 0.004 - 2.0 * 0.05, 0.0)).norm(), 1e-12);
  EXPECT_EQ(force_of(wall, {{0.0, 0.001, 0.0}, {0.0, -1.0, 0.0}}).norm(), 0.0) << "above it";
  EXPECT_EQ(force_of(wall, {{0.0, -0.001, 0.0}, {0.0, 1.0, 0.0}}).norm(), 0.0) << "never pulls";
}

TEST(SceneTest, SolidsPushOutAndHollowsKeepIn) {
  const auto at = [](const Shape& shape, bool inside, const Vector3d& p) {
    return force_of(field("s", SurfaceParameters{shape, inside, {1000.0, 0.0}}),
                    {p, Vector3d::Zero()});
  };
  const Sphere ball{kOrigin, 0.02};
  EXPECT_LT((at(ball, false, {0.0, 0.0, 0.018}) - Vector3d(0.0, 0.0, 2.0)).norm(), 1e-12);
  EXPECT_EQ(at(ball, false, {0.0, 0.0, 0.021}).norm(), 0.0);
  EXPECT_LT((at(ball, true, {0.0, 0.0, 0.023}) - Vector3d(0.0, 0.0, -3.0)).norm(), 1e-12);
  EXPECT_EQ(at(ball, true, {0.0, 0.0, 0.019}).norm(), 0.0);
  const Cylinder bar{kOrigin, {0.0, 0.0, 1.0}, 0.02};
  EXPECT_LT((at(bar, true, {0.0, 0.021, 5.0}) - Vector3d(0.0, -1.0, 0.0)).norm(), 1e-12);
  const Box block{kOrigin, {0.04, 0.04, 0.04}};
  EXPECT_LT((at(block, false, {0.001, 0.017, 0.0}) - Vector3d(0.0, 3.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((at(block, true, {0.023, 0.024, 0.0}) - Vector3d(-3.0, -4.0, 0.0)).norm(), 1e-12);
}

/// The largest step of the force on a hand that goes straight through at 0.15 m/s [N in 1 ms].
double largest_step(const Field& surface) {
  Scene scene({surface}, kRate);
  scene.switch_to(Scene::kAll);
  Vector3d last = Vector3d::Zero();
  double largest = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const Vector3d force = scene.force({{1e-9, 0.03 - 0.15e-3 * i, 0.0}, {0.0, -0.15, 0.0}});
    largest = std::max(largest, (force - last).norm());
    last = force;
  }
  return largest;
}

/// In the middle the force of 10 N fades and comes back over 4 mm; that of a damper begins over 1
/// mm.
TEST(SceneTest, AHandThatIsPushedThroughAShapeIsNotStruck) {
  for (const Shape& shape : {Shape(Sphere{kOrigin, 0.02}), Shape(Box{kOrigin, {0.04, 0.04, 0.04}}),
                             Shape(Cylinder{kOrigin, {0.0, 0.0, 1.0}, 0.02})}) {
    EXPECT_LT(largest_step(field("s", SurfaceParameters{shape, false, {800.0, 0.0}})), 0.7501);
    EXPECT_LT(largest_step(field("s", SurfaceParameters{shape, false, {800.0, 20.0}})), 0.7501);
  }
}

TEST(SceneTest, ChannelsAreFreeAlongTheirAxes) {
  const PointState hand{{0.02, 0.003, -0.01}, {0.3, 0.1, -0.2}};
  const Vector3d axes =
      force_of(field("c", AxisChannelParameters{kOrigin, true, false, true, {1000.0, 15.0}}), hand);
  EXPECT_LT((axes - Vector3d(0.0, -3.0 - 1.5, 0.0)).norm(), 1e-12);
  const Vector3d plane = force_of(
      field("p", PlaneParameters{{0.0, 0.001, 0.0}, {0.0, -2.0, 0.0}, {1000.0, 0.0}}), hand);
  EXPECT_LT((plane - Vector3d(0.0, -2.0, 0.0)).norm(), 1e-12);
  RandomStream random(1, "channel");
  const Vector3d from(0.01, 0.0, 0.0);
  const Vector3d to(0.05, 0.03, -0.02);
  for (int i = 0; i < 100; ++i) {
    const PointState any = random_hand(random);
    const Vector3d f = force_of(field("c", LineChannelParameters{from, to, {200.0, 3.0}}), any);
    ASSERT_NEAR(f.dot((to - from).normalized()), 0.0, 1e-12);
    const double off = (any.position - from).cross((to - from).normalized()).norm();
    const Vector3d still = force_of(field("c", LineChannelParameters{from, to, {200.0, 3.0}}),
                                    {any.position, Vector3d::Zero()});
    ASSERT_NEAR(still.norm(), std::min(200.0 * off, 10.0), 1e-9);
  }
}

TEST(SceneTest, ACurlFieldPushesAcrossTheVelocity) {
  MatrixViscousParameters curl;
  curl.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  RandomStream random(2, "curl");
  for (int i = 0; i < 100; ++i) {
    Scene scene({field("curl", curl, 100.0)}, kRate);
    scene.switch_to(1);
    PointState hand = random_hand(random);
    hand.velocity.y() = 0.0;
    const Vector3d force = scene.force(hand);  // a filter begins at its first velocity
    ASSERT_NEAR(force.dot(hand.velocity), 0.0, 1e-12);
    ASSERT_NEAR(force.norm(), 13.0 * hand.velocity.norm(), 1e-12);
    // Counterclockwise seen from y: to the left of the way, W's z points to the participant.
    ASSERT_NEAR(force.x(), 13.0 * hand.velocity.z(), 1e-12);
  }
}

TEST(SceneTest, TheVelocityFilterHasItsCutOff) {
  MatrixViscousParameters drag;
  drag.matrix = -Eigen::Matrix3d::Identity();
  drag.velocity_filter = 30.0;
  Scene scene({field("drag", drag)}, kRate);
  scene.switch_to(1);
  scene.force({});
  for (int i = 1; i <= 20; ++i) {
    const double force = -scene.force({Vector3d::Zero(), Vector3d::UnitX()}).x();
    ASSERT_NEAR(force, 1.0 - std::exp(-2.0 * M_PI * 30.0 * i / kRate), 1e-12);
    ASSERT_NEAR(scene.state(0).velocity.x(), force, 1e-12);
  }
}

TEST(SceneTest, ForcesAreAddedWhateverTheOrderOfTheFields) {
  const std::vector<Field> fields = every_kind();
  const std::vector<Field> turned(fields.rbegin(), fields.rend());
  Scene scene(fields, kRate);
  Scene other(turned, kRate);
  scene.switch_to(Scene::kAll);
  other.switch_to(Scene::kAll);
  RandomStream random(3, "sum");
  for (int i = 0; i < 200; ++i) {
    const PointState hand = random_hand(random);
    const Vector3d total = scene.force(hand);
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = 0; k < scene.size(); ++k) {
      sum += scene.state(k).force;
      ASSERT_LE(scene.state(k).force.norm(), fields[k].limit * (1.0 + 1e-12)) << fields[k].name;
    }
    ASSERT_LT((total - sum).norm(), 1e-9);
    ASSERT_LT((total - other.force(hand)).norm(), 1e-9);
  }
}

TEST(SceneTest, TheLimitKeepsTheDirection) {
  RandomStream random(4, "limit");
  for (int i = 0; i < 200; ++i) {
    const PointState hand = random_hand(random);
    const SpringParameters spring{{0.05, 0.0, 0.0}, {900.0, 20.0}};
    const Vector3d whole = force_of(field("s", spring, 1e6), hand);
    const Vector3d cut = force_of(field("s", spring, 3.0), hand);
    ASSERT_LT((cut - whole * std::min(1.0, 3.0 / whole.norm())).norm(), 1e-12);
  }
  Scene scene({field("s", SpringParameters{{0.05, 0.0, 0.0}, {900.0, 0.0}}, 3.0)}, kRate);
  scene.switch_to(1);
  scene.force({});
  EXPECT_TRUE(scene.state(0).limited);
  scene.force({{0.049, 0.0, 0.0}, Vector3d::Zero()});
  EXPECT_FALSE(scene.state(0).limited);
}

TEST(SceneTest, SwitchedFieldsFadeSmoothly) {
  Field push = field("push", ConstantParameters{{2.0, 0.0, 0.0}});
  push.fade_in = 0.1;
  push.fade_out = 0.2;
  Scene scene({field("other", ConstantParameters{{0.0, 1.0, 0.0}}), push}, kRate);
  scene.switch_to(0b10);
  double before = 0.0;
  for (int i = 0; i < 150; ++i) {
    const double x = scene.force({}).x();
    const double u = std::min(i * 0.01, 1.0);
    ASSERT_NEAR(x, 2.0 * u * u * (3.0 - 2.0 * u), 1e-9) << i;
    ASSERT_LE(std::abs(x - before), 2.0 * 1.5 / 100.0 + 1e-12) << "the steepest of the fade";
    before = x;
  }
  EXPECT_EQ(scene.mask(), 0b10u);
  scene.switch_to(0);
  for (int i = 0; i < 250; ++i) {
    const double x = scene.force({}).x();
    ASSERT_LE(std::abs(x - before), 2.0 * 1.5 / 200.0 + 1e-12);
    before = x;
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(scene.state(0).force.norm(), 0.0) << "was never switched on";
}

TEST(SceneTest, AFieldBeginsAnewWhenItIsSwitchedOnAgain) {
  Scene scene({field("ramp", RampParameters{kOrigin, {2.0, 0.0, 0.0}, 0.1})}, kRate);
  for (int round = 0; round < 2; ++round) {
    scene.switch_to(1);
    for (int i = 0; i < 60; ++i) {
      ASSERT_NEAR(scene.force({}).x(), 2.0 * i / 100.0, 1e-9);
    }
    scene.switch_to(1);  // goes on
    EXPECT_NEAR(scene.force({}).x(), 1.2, 1e-9);
    scene.switch_to(0);
    EXPECT_EQ(scene.force({}).x(), 0.0);
  }
}

/// Fields whose force depends on when they began, with a fade that is part of it.
std::vector<Field> every_timed_kind() {
  std::vector<Field> fields{field("ramp", RampParameters{kOrigin, {2.0, 0.0, 0.0}, 0.1}),
                            field("pulse", PulseParameters{{0.0, 3.0, 0.0}, 0.03, 0.1, 0.02}),
                            field("tap", TapParameters{"", {0.0, 0.0, 1.0}}),
                            field("mover", MoverParameters{{0.03, 0.0, 0.0}, 0.2}),
                            field("path", PathParameters{{kOrigin, {0.0, 0.02, 0.0}}, 0.15})};
  for (Field& each : fields) {
    each.fade_in = 0.02;
  }
  return fields;
}

TEST(SceneTest, ACourseInTimeIsTheSameInEveryInterval) {
  const std::vector<Field> fields = every_timed_kind();
  const PointState held{{0.01, -0.005, 0.002}, Vector3d::Zero()};
  Scene first(fields, kRate);
  first.restart_with(Scene::kAll);
  std::vector<Vector3d> forces(180);
  for (Vector3d& force : forces) {
    force = first.force(held);
  }
  Scene second(fields, kRate);
  second.start_from(first);
  second.restart_with(Scene::kAll);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    ASSERT_LT((second.force(held) - forces[i]).norm(), 1e-12) << i << " ms of the next interval";
  }
  second.restart_with(Scene::kAll);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    ASSERT_LT((second.force(held) - forces[i]).norm(), 1e-12) << i << " ms of the repetition";
  }
  second.switch_to(Scene::kAll);
  EXPECT_GT((second.force(held) - forces[0]).norm(), 1.0) << "the next stage goes on";
}

/// The stages of an interval that begin without a field must not tell what it will be like.
TEST(SceneTest, WhatFadesOutHasTheNumbersOfItsOwnInterval) {
  const auto pushing = [](double force) {
    Field wave = field("wave", SineVibrationParameters{{force, 0.0, 0.0}, force, 50.0});
    std::vector<Field> fields{field("push", ConstantParameters{{0.0, force, 0.0}}), wave,
                              field("spring", SpringParameters{{0.0, 0.0, 0.01}, {100.0 * force}})};
    for (Field& each : fields) {
      each.fade_in = 0.02;
      each.fade_out = 0.2;
    }
    return fields;
  };
  Scene alone(pushing(0.5), kRate);  // goes on by itself
  Scene first(pushing(0.5), kRate);
  for (Scene* scene : {&alone, &first}) {
    scene->restart_with(Scene::kAll);
    for (int i = 0; i < 100; ++i) {
      scene->force({});
    }
  }
  Scene second(pushing(5.0), kRate);
  Scene fresh(pushing(5.0), kRate);
  {
    const haptrial::test::AllocationGuard guard;
    second.start_from(first);
    second.restart_with(0);
    EXPECT_EQ(guard.count(), 0u);
  }
  alone.restart_with(0);
  for (int i = 0; i < 300; ++i) {
    ASSERT_LT((second.force({}) - alone.force({})).norm(), 1e-12) << i;
  }
  for (Scene* scene : {&second, &fresh}) {
    scene->switch_to(Scene::kAll);
  }
  for (int i = 0; i < 100; ++i) {
    ASSERT_LT((second.force({}) - fresh.force({})).norm(), 1e-12) << i << ", its own numbers";
  }
}

/// The spring's end is on the polynomial of Flash and Hogan, from the hand to the new place.
TEST(SceneTest, TheNextIntervalLeadsTheHandFromWhereItIs) {
  const auto mover_to = [](double x) {
    return std::vector<Field>{field("mover", MoverParameters{{x, 0.0, 0.0}, 0.5, {100.0, 0.0}})};
  };
  Scene first(mover_to(-0.03), kRate);
  first.restart_with(1);
  const PointState there{{-0.029, 0.0, 0.0}, Vector3d::Zero()};
  for (int i = 0; i < 600; ++i) {
    first.force(there);
  }
  Scene second(mover_to(0.03), kRate);
  second.start_from(first);
  second.restart_with(1);
  for (int i = 0; i <= 500; ++i) {
    const double u = i / 500.0;
    const double moved = 0.059 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    ASSERT_NEAR(second.force(there).x(), 100.0 * moved, 1e-9) << i;
  }
}

/// Interval without a gap: what is felt goes over to the numbers of the next.
TEST(SceneTest, AVibrationThatGoesOnWithOtherNumbersMakesNoStep) {
  const auto largest_step = [](const FieldKind& one, const FieldKind& two) {
    Scene first({field("buzz", one)}, kRate);
    first.restart_with(1);
    Vector3d last = kOrigin;
    for (int i = 0; i < 503; ++i) {
      last = first.force({});
    }
    Scene second({field("buzz", two)}, kRate);
    second.start_from(first);
    second.restart_with(1);
    double step = 0.0;
    for (int i = 0; i < 300; ++i) {
      const Vector3d force = second.force({});
      step = std::max(step, (force - last).norm());
      last = force;
    }
    return step;
  };
  const auto sine = [](double amplitude, double frequency, double phase) {
    return SineVibrationParameters{{0.0, 1.0, 0.0}, amplitude, frequency, phase};
  };
  constexpr double kTurn = 2.0 * std::numbers::pi / kRate;  // of 1 Hz in a tick
  EXPECT_LT(largest_step(sine(0.5, 20.5, 0.0), sine(5.0, 20.5, 0.0)), 1.1 * 5.0 * 20.5 * kTurn);
  EXPECT_LT(largest_step(sine(1.0, 20.5, 0.0), sine(1.0, 35.0, 0.0)), 35.0 * kTurn);
  EXPECT_LT(largest_step(sine(1.0, 20.5, 0.0), sine(1.0, 20.5, 2.0)), 20.5 * kTurn);
  const auto noise = [](double rms, std::uint64_t seed) {
    return NoiseVibrationParameters{{0.0, 1.0, 0.0}, rms, 10.0, 30.0, seed};
  };
  const double natural = largest_step(noise(1.0, 1), noise(1.0, 1));
  EXPECT_LT(largest_step(noise(0.2, 1), noise(1.0, 2)), 1.5 * natural);
}

/// The force of ridges under a moving hand is a stimulus of their surface.
TEST(SceneTest, RidgesThatEndOrChangeUnderAMovingHandAreKnownOnTheNextTick) {
  const auto ridged = [](double amplitude) {
    return std::vector<Field>{
        test::surface(HalfSpace{}),
        field("ridges", GratingParameters{"floor", Vector3d::UnitX(), amplitude, 0.004})};
  };
  const auto stroke = [](Scene& scene, int from, int ticks) {
    for (int i = from; i < from + ticks; ++i) {
      scene.force({{1e-4 * i, -0.002, 0.0}, {0.1, 0.0, 0.0}});
    }
    return scene.state(0).stimulus;
  };
  Scene scene(ridged(0.0004), kRate);
  scene.restart_with(0b11);
  const Vector3d before = stroke(scene, 0, 613);
  ASSERT_GT(before.norm(), 0.05);
  EXPECT_EQ(scene.ended(), kOrigin);
  Scene next(ridged(0.0001), kRate);
  next.start_from(scene);
  next.restart_with(0b11);
  const Vector3d after = stroke(next, 613, 1);
  EXPECT_LT((next.ended() - (before - after)).norm(), 1e-12) << "other ridges";
  Scene same(ridged(0.0001), kRate);
  same.start_from(next);
  same.restart_with(0b11);
  const Vector3d last = stroke(same, 614, 1);
  EXPECT_EQ(same.ended(), kOrigin) << "the same ridges";
  same.switch_to(0b01);
  stroke(same, 615, 1);
  EXPECT_LT((same.ended() - last).norm(), 1e-12) << "no ridges";
}

TEST(SceneTest, AStimulusThatIsCutOffIsKnownOnTheNextTick) {
  Field wave = field("wave", SineVibrationParameters{{0.0, 1.0, 0.0}, 2.0, 50.0});
  wave.fade_out = 0.1;
  const std::vector<Field> fields{field("long", PulseParameters{{3.0, 0.0, 0.0}, 0.0, 5.0}),
                                  field("other", PulseParameters{{0.0, 0.0, 4.0}, 0.0, 5.0}), wave};
  Scene scene(fields, kRate);
  scene.restart_with(Scene::kAll);
  scene.force({});
  EXPECT_EQ(scene.ended(), kOrigin);
  scene.switch_to(0b010);
  scene.force({});
  EXPECT_EQ(scene.ended(), Vector3d(3.0, 0.0, 0.0)) << "the vibration fades, the other goes on";
  scene.force({});
  EXPECT_EQ(scene.ended(), kOrigin) << "once";
  Scene next(fields, kRate);
  next.start_from(scene);
  next.restart_with(0b010);
  next.force({});
  EXPECT_EQ(next.ended(), Vector3d(0.0, 0.0, 4.0)) << "it begins anew with the next interval";
}

/// A stage without the pulse that is shorter than its fade lies between two with it.
TEST(SceneTest, APulseComesAgainWithinItsFade) {
  Field pulse = field("pulse", PulseParameters{{0.0, 3.0, 0.0}, 0.0, 0.05});
  pulse.fade_out = 0.1;
  Scene scene({pulse}, kRate);
  for (int round = 0; round < 2; ++round) {
    scene.switch_to(1);
    double impulse = 0.0;
    for (int i = 0; i < 60; ++i) {
      impulse += scene.force({}).y() / kRate;
    }
    EXPECT_NEAR(impulse, 3.0 * 0.05, 1e-9);
    scene.switch_to(0);
    scene.force({});
  }
}

TEST(SceneTest, WhatWasFeltCanBeRead) {
  Scene scene({test::surface(HalfSpace{}, false, 0.0)}, kRate);
  scene.switch_to(1);
  for (int i = 0; i <= 1000; ++i) {
    const double y = 0.002 - 0.006 * std::sin(M_PI * i / 1000.0);
    scene.force({{0.0, y, 0.0}, Vector3d::Zero()});
    ASSERT_EQ(scene.state(0).contact, y < 0.0);
    ASSERT_NEAR(scene.state(0).depth, std::max(-y, 0.0), 1e-15);
  }
  EXPECT_NEAR(scene.state(0).max_depth, 0.004, 1e-9);
  EXPECT_NEAR(scene.state(0).max_force, 3.2, 1e-6);
  // Held forces give back a little more than they took: half of k dx² a tick.
  EXPECT_GT(scene.state(0).work, 0.0);
  EXPECT_LT(scene.state(0).work, 0.5 * 800.0 * 1000.0 * std::pow(0.006 * M_PI / 1000.0, 2));
  scene.forget_extremes();
  EXPECT_EQ(scene.state(0).max_depth, 0.0);
  scene.force({{0.0, -0.001, 0.0}, Vector3d::Zero()});
  EXPECT_TRUE(scene.state(0).contact);
  scene.switch_to(0);
  scene.force({{0.0, -0.001, 0.0}, Vector3d::Zero()});
  EXPECT_FALSE(scene.state(0).contact) << "does not act";
  EXPECT_EQ(scene.state(0).max_depth, 0.001) << "what was felt stays";
}

TEST(SceneTest, AHandThatIsNotFiniteGetsNoForceAndLeavesNoTrace) {
  Scene scene(every_kind(), kRate);
  Scene spared(every_kind(), kRate);
  scene.switch_to(Scene::kAll);
  spared.switch_to(Scene::kAll);
  RandomStream random(5, "nan");
  for (int i = 0; i < 50; ++i) {
    const PointState hand = random_hand(random);
    const Vector3d force = scene.force(hand);
    ASSERT_EQ(force, spared.force(hand));
    PointState lost = hand;
    (i % 2 == 0 ? lost.position : lost.velocity).z() = std::numeric_limits<double>::quiet_NaN();
    ASSERT_EQ(scene.force(lost).norm(), 0.0);
  }
}

TEST(SceneTest, ANewSceneGoesOnWhereTheOldOneWas) {
  // Between trials the wall's stiffness changes; friction, filter and phase of the rest go on.
  std::vector<Field> fields = every_kind();
  Scene one(fields, kRate);
  Scene reference(fields, kRate);
  one.switch_to(Scene::kAll);
  reference.switch_to(Scene::kAll);
  RandomStream random(6, "next");
  for (int i = 0; i < 30; ++i) {
    const PointState hand = random_hand(random);
    one.force(hand);
    reference.force(hand);
  }
  Scene next(fields, kRate);
  next.start_from(one);
  for (int i = 0; i < 30; ++i) {
    const PointState hand = random_hand(random);
    ASSERT_LT((next.force(hand) - reference.force(hand)).norm(), 1e-12) << i;
  }
}

TEST(SceneTest, FrictionFollowsTheSurfaceItLiesOn) {
  const std::vector<Field> fields{field("rub", FrictionParameters{"floor", 0.5, 0.5, 2000.0}),
                                  test::surface(HalfSpace{}, false, 0.0)};
  Scene scene(fields, kRate);
  scene.switch_to(0b11);
  for (int i = 0; i < 200; ++i) {
    scene.force({{1e-4 * i, -0.003, 0.0}, Vector3d::Zero()});
  }
  EXPECT_NEAR(scene.state(0).force.x(), -0.5 * 2.4, 1e-9) << "mu k depth";
  EXPECT_TRUE(scene.state(0).sliding);
  scene.switch_to(0b01);
  EXPECT_EQ(scene.force({{0.03, -0.003, 0.0}, Vector3d::Zero()}).norm(), 0.0) << "no surface";
}

TEST(SceneTest, NothingOfATickAllocates) {
  Scene scene(every_kind(), kRate);
  Scene next(every_kind(), kRate);
  RandomStream random(7, "allocation");
  std::vector<PointState> hands(50);
  for (PointState& hand : hands) {
    hand = random_hand(random);
  }
  const haptrial::test::AllocationGuard guard;
  scene.switch_to(Scene::kAll);
  for (const PointState& hand : hands) {
    scene.force(hand);
  }
  scene.switch_to(0b1011);
  scene.forget_extremes();
  next.start_from(scene);
  next.force(hands[0]);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(SceneTest, BadScenesAreNamed) {
  const auto told = [](const std::vector<Field>& fields) {
    return haptrial::test::message_of<std::invalid_argument>([&] { Scene scene(fields, kRate); });
  };
  EXPECT_THAT(told({field("soft", SpringParameters{kOrigin, {-1.0, 0.0}})}),
              testing::AllOf(HasSubstr("soft"), HasSubstr("stiffness")));
  EXPECT_THAT(told({field("a", SpringParameters{}), field("a", SpringParameters{})}),
              HasSubstr("twice"));
  EXPECT_THAT(told({field("rub", FrictionParameters{"floor"})}), HasSubstr("floor"));
  EXPECT_THAT(
      told({field("floor", SpringParameters{}), field("ridges", GratingParameters{"floor"})}),
      HasSubstr("not a surface"));
  EXPECT_THAT(told({field("ridges", GratingParameters{})}), HasSubstr("must lie on a surface"));
  EXPECT_THAT(told({field("a", SpringParameters{}, 0.0)}), HasSubstr("limit"));
  EXPECT_THAT(told({Field{"a", SpringParameters{}, 1.0, -0.1}}), HasSubstr("fade_in"));
  EXPECT_THAT(told(std::vector<Field>(65)), HasSubstr("at most 64"));
}

}  // namespace
}  // namespace haptrial::scene::scene_test
