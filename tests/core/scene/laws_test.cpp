// Laws that are written once and hold for many fields: the force is minus the gradient of the
// energy; a sampled passive field gives out no more than its needed damping takes.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/random.h"
#include "core/scene/needed_damping.h"
#include "core/scene/scene.h"
#include "tests/core/scene/every_scene.h"

namespace haptrial::scene::laws_test {
namespace {

using Eigen::Vector3d;
using test::kOrigin;
using Motion = std::vector<Vector3d>;  // one place a tick, closed: after the last comes the first
using Law = std::function<Vector3d(const PointState&)>;

constexpr double kRate = 1000.0;

// --- conservative -----------------------------------------------------------------------------

TEST(SceneLawTest, TheForceOfConservativeFieldsIsMinusTheGradientOfTheirEnergy) {
  constexpr double kStep = 1e-6;
  for (const test::Example& example : test::conservative_scenes()) {
    Scene scene(example.fields, kRate);
    scene.switch_to(Scene::kAll);
    RandomStream random(1, example.name);
    int pushed = 0;
    for (int i = 0; i < 400; ++i) {
      const Vector3d p(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03),
                       random.uniform(-0.03, 0.03));
      const Vector3d force = scene.force({p, Vector3d::Zero()});
      Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d aside = kStep * Vector3d::Unit(axis);
        gradient[axis] = (scene.energy(p + aside) - scene.energy(p - aside)) / (2.0 * kStep);
      }
      ASSERT_LT((force + gradient).norm(), 1e-3 * (1.0 + force.norm()))
          << example.name << " at " << p.transpose() << ": " << force.transpose() << ", "
          << -gradient.transpose();
      pushed += force.norm() > 0.0;
    }
    EXPECT_GT(pushed, 20) << example.name;
  }
}

// --- passive ----------------------------------------------------------------------------------

struct GivenEnergy {
  double energy{0.0};  // by the held forces, over one round [J]
  double travel{0.0};  // Σ |Δx|² / T: the least integral of |v|² of a hand that makes this way
};

/// Round three of a closed motion: filters and bristles have then found their cycle. The velocity
/// is the last difference.
GivenEnergy round_three(const Law& law, const Motion& motion) {
  GivenEnergy given;
  Vector3d before = motion.back();
  for (int round = 0; round < 3; ++round) {
    given = {};
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const Vector3d force = law({motion[i], kRate * (motion[i] - before)});
      const Vector3d way = motion[(i + 1) % motion.size()] - motion[i];
      given.energy += force.dot(way);
      given.travel += kRate * way.squaredNorm();
      before = motion[i];
    }
  }
  return given;
}

Vector3d random_vector(RandomStream& random, double size) {
  return size * Vector3d(random.normal(), random.normal(), random.normal());
}

/// Sums of sines up to `highest` Hz over two seconds.
Motion smooth_motion(RandomStream& random, double size, double highest) {
  Motion motion(2000, random_vector(random, 0.3 * size));
  for (int wave = 1; wave <= 2.0 * highest; wave += 1 + static_cast<int>(0.1 * highest)) {
    const Vector3d a = random_vector(random, size / (1.0 + 0.3 * wave));
    const Vector3d b = random_vector(random, size / (1.0 + 0.3 * wave));
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const double turn = 2.0 * M_PI * wave * static_cast<double>(i) / 2000.0;
      motion[i] += std::cos(turn) * a + std::sin(turn) * b;
    }
  }
  return motion;
}

Motion scattered_motion(RandomStream& random, double size) {
  Motion motion(2000);
  for (Vector3d& p : motion) {
    p = random_vector(random, size);
  }
  return motion;
}

/// Motion to and fro on every tick, the fastest that a sampled loop can see, while the middle
/// wanders.
Motion shaking_motion(RandomStream& random, double size) {
  Motion motion = smooth_motion(random, 0.01, 2.0);
  const Vector3d aside = random_vector(random, size);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion[i] += (i % 2 == 0 ? 1.0 : -1.0) * aside;
  }
  return motion;
}

std::vector<Motion> every_motion(const std::string& name) {
  RandomStream random(2, name);
  std::vector<Motion> motions;
  for (int i = 0; i < 6; ++i) {
    motions.push_back(smooth_motion(random, 0.012, 4.0));
    motions.push_back(smooth_motion(random, 0.004, 40.0));
    motions.push_back(scattered_motion(random, i < 3 ? 0.01 : 0.001));
    motions.push_back(shaking_motion(random, i < 3 ? 0.002 : 0.0001));
  }
  return motions;
}

double needed_by(const std::vector<Field>& fields) {
  double needed = 0.0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const StiffnessBound bound = stiffness_bound(fields, i);
    EXPECT_TRUE(bound.passive) << fields[i].name;
    needed += needed_damping(bound, kRate);
  }
  return needed;
}

Law law_of(Scene& scene) {
  return [&scene](const PointState& hand) { return scene.force(hand); };
}

TEST(SceneLawTest, PassiveFieldsGiveNoMoreThanTheNeededDampingTakes) {
  for (const test::Example& example : test::passive_scenes()) {
    const double needed = needed_by(example.fields);
    for (const Motion& motion : every_motion(example.name)) {
      Scene scene(example.fields, kRate);
      scene.switch_to(Scene::kAll);
      const GivenEnergy given = round_three(law_of(scene), motion);
      ASSERT_LE(given.energy, needed * given.travel + 1e-9) << example.name;
    }
  }
}

TEST(SceneLawTest, InSlowMotionTheirDampersAskForNothing) {
  // K T / 2 alone, the bound of the virtual coupling: dampers give energy only to a shaking hand.
  for (const test::Example& example : test::passive_scenes()) {
    double springs = 0.0;
    for (std::size_t i = 0; i < example.fields.size(); ++i) {
      springs += 0.5 * stiffness_bound(example.fields, i).stiffness / kRate;
    }
    RandomStream random(3, example.name);
    for (int i = 0; i < 10; ++i) {
      Scene scene(example.fields, kRate);
      scene.switch_to(Scene::kAll);
      const GivenEnergy given = round_three(law_of(scene), smooth_motion(random, 0.012, 4.0));
      ASSERT_LE(given.energy, springs * given.travel + 1e-9) << example.name;
    }
  }
}

TEST(SceneLawTest, TheBoundIsReachedByASpringAndADamperThatAreShaken) {
  RandomStream random(4, "shaken");
  const std::vector<Field> fields{
      test::field("spring", SpringParameters{kOrigin, {600.0, 2.0}}, 1e3)};
  Scene scene(fields, kRate);
  scene.switch_to(Scene::kAll);
  Motion shaken(1000, Vector3d(0.001, 0.002, 0.0));
  for (std::size_t i = 0; i < shaken.size(); i += 2) {
    shaken[i] *= -1.0;
  }
  const GivenEnergy given = round_three(law_of(scene), shaken);
  EXPECT_NEAR(given.energy, needed_by(fields) * given.travel, 1e-9 * given.energy);
}

TEST(SceneLawTest, BelowAFrequencyTheDamperHelpsAsStated) {
  // One sine is an eigenvector of spring and damper: the statement is an equation.
  const std::vector<Field> fields{
      test::field("spring", SpringParameters{kOrigin, {3000.0, 1.0}}, 1e4)};
  for (const double frequency : {1.0, 20.0, 150.0, 400.0, 500.0}) {
    Scene scene(fields, kRate);
    scene.switch_to(Scene::kAll);
    Motion motion(1000);
    for (std::size_t i = 0; i < motion.size(); ++i) {
      motion[i] = Vector3d(
          0.001 * std::cos(2.0 * M_PI * frequency * static_cast<double>(i) / kRate), 0.0, 0.0);
    }
    const GivenEnergy given = round_three(law_of(scene), motion);
    EXPECT_NEAR(given.energy / given.travel,
                needed_damping_below(frequency, stiffness_bound(fields, 0), kRate), 1e-7)
        << frequency;
  }
}

TEST(SceneLawTest, TheLawFindsFieldsThatGiveEnergy) {
  RandomStream random(5, "active");
  const Motion slow = smooth_motion(random, 0.012, 4.0);
  // A spring whose force is five ticks late.
  std::vector<Vector3d> late(5, Vector3d::Zero());
  const GivenEnergy spring = round_three(
      [&](const PointState& hand) {
        late.push_back(-1000.0 * hand.position);
        const Vector3d force = late.front();
        late.erase(late.begin());
        return force;
      },
      slow);
  EXPECT_GT(spring.energy, 0.5 * 1000.0 / kRate * spring.travel);
  // A damper of the wrong sign, and a curl field whose velocity is filtered.
  MatrixViscousParameters push;
  push.matrix = Eigen::Matrix3d::Identity();
  MatrixViscousParameters curl;
  curl.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  curl.velocity_filter = 5.0;
  Motion circle(1000);
  for (std::size_t i = 0; i < circle.size(); ++i) {
    const double a = 2.0 * M_PI * static_cast<double>(i) / 1000.0;
    circle[i] = 0.03 * Vector3d(std::cos(a), 0.0, std::sin(a));
  }
  double best = 0.0;
  for (const MatrixViscousParameters& parameters : {push, curl}) {
    const std::vector<Field> fields{test::field("matrix", parameters)};
    EXPECT_FALSE(stiffness_bound(fields, 0).passive);
    Motion back(circle.rbegin(), circle.rend());
    best = 0.0;
    for (const Motion& motion : {circle, back}) {
      Scene scene(fields, kRate);
      scene.switch_to(Scene::kAll);
      best = std::max(best, round_three(law_of(scene), motion).energy);
    }
    EXPECT_GT(best, 1e-3);
  }
}

TEST(NeededDampingTest, SaysWhatColgateAndSchenkelSay) {
  const std::vector<Field> fields{test::surface(HalfSpace{}, false, 3.0)};
  const StiffnessBound wall = stiffness_bound(fields, 0);
  EXPECT_DOUBLE_EQ(needed_damping(wall, 1000.0), 800.0 * 0.001 / 2.0 + 3.0);
  EXPECT_DOUBLE_EQ(needed_damping(wall, 4000.0), 800.0 * 0.00025 / 2.0 + 3.0);
  EXPECT_DOUBLE_EQ(needed_damping_below(0.0, wall, 1000.0), 800.0 * 0.001 / 2.0 - 3.0);
  EXPECT_DOUBLE_EQ(needed_damping_below(500.0, wall, 1000.0), needed_damping(wall, 1000.0));
}

TEST(NeededDampingTest, FieldsOfTimeAndLateAccelerationAreNotPassive) {
  const std::vector<FieldKind> active{
      RampParameters{},          PulseParameters{},          InertiaParameters{},
      SineVibrationParameters{}, NoiseVibrationParameters{}, TapParameters{},
      MoverParameters{},         PathParameters{},           MeasuredParameters{}};
  for (const FieldKind& kind : active) {
    EXPECT_FALSE(stiffness_bound({test::field("active", kind)}, 0).passive) << kind.index();
  }
  MatrixViscousParameters curl;
  curl.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  EXPECT_FALSE(stiffness_bound({test::field("curl", curl)}, 0).passive)
      << "behind its filter of 30 Hz";
  curl.velocity_filter = INFINITY;
  EXPECT_TRUE(stiffness_bound({test::field("curl", curl)}, 0).passive) << "turns the hand, no more";
  EXPECT_NEAR(stiffness_bound({test::field("curl", curl)}, 0).damping, 13.0, 1e-12);
}

// Along its eigenvectors a matrix of 3 and -5 N·s/m pushes on and damps; a curl does neither.
TEST(NeededDampingTest, AMatrixIsPartedIntoWhatDrivesAndWhatDamps) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).matrix();
  MatrixViscousParameters saddle;
  saddle.matrix = turn * Vector3d(3.0, -5.0, 0.0).asDiagonal() * turn.transpose();
  const StiffnessBound bound = stiffness_bound({test::field("saddle", saddle)}, 0);
  EXPECT_FALSE(bound.passive);
  EXPECT_NEAR(bound.driving, 3.0, 1e-12);
  EXPECT_NEAR(bound.damping, 5.0, 1e-12);
  EXPECT_NEAR(needed_damping_below(0.0, bound, kRate), 3.0, 1e-12) << "for a slow hand";
  MatrixViscousParameters damper;
  damper.matrix = Vector3d(-8.0, -5.0, -1.0).asDiagonal();
  EXPECT_NEAR(stiffness_bound({test::field("oil", damper)}, 0).driving, -1.0, 1e-12);
  MatrixViscousParameters curl;
  curl.matrix << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  EXPECT_EQ(stiffness_bound({test::field("curl", curl)}, 0).driving, 0.0);
}

// The law of the needed damping holds for fields that drive motions, too, and D is needed.
TEST(NeededDampingTest, HoldsForAMatrixThatPushesMotionsOn) {
  MatrixViscousParameters push;
  push.matrix = Vector3d(4.0, -2.0, 1.0).asDiagonal();
  push.velocity_filter = INFINITY;
  const std::vector<Field> fields{test::field("push", push, 1e3)};
  const double needed = needed_damping(stiffness_bound(fields, 0), kRate);
  double most = -INFINITY;
  for (const Motion& motion : every_motion("push")) {
    Scene scene(fields, kRate);
    scene.switch_to(Scene::kAll);
    const GivenEnergy given = round_three(law_of(scene), motion);
    ASSERT_LE(given.energy, needed * given.travel + 1e-9);
    most = std::max(most, given.energy / given.travel);
  }
  EXPECT_GT(most, 0.0);
}

}  // namespace
}  // namespace haptrial::scene::laws_test
