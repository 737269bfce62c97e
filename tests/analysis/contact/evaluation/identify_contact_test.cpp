#include "analysis/contact/evaluation/identify_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/contact/contact_surface.h"
#include "core/contact/proxy.h"
#include "analysis/contact/truth/true_contact.h"

namespace haptrial::evaluation::identify_contact_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kPeriod = 0.001;     // [s]
constexpr double kStiffness = 800.0;  // [N/m]
constexpr double kSphere = 0.05;      // [m]
constexpr int kTicks = 5000;

/// Path of a hand over a plane y = 0: strokes of 24 mm with pauses, 1 to 3 mm deep, in the air at
/// first.
std::vector<Vector3d> rubbing(RandomStream& random, double depth = 0.002) {
  const double a = 6.0 * random.uniform(), b = 6.0 * random.uniform(), c = 6.0 * random.uniform();
  std::vector<Vector3d> tool;
  for (int i = 0; i < kTicks; ++i) {
    const double t = i * kPeriod, turn = 9.1 * t - 0.5 * std::sin(18.2 * t) + a;
    const double in = depth + 0.4 * depth * std::sin(7.3 * t + b);
    tool.emplace_back(0.012 * std::sin(turn), 0.001 - (in + 0.001) * std::min(1.0, 10.0 * t),
                      0.004 * std::sin(0.9 * t + c));
  }
  return tool;
}

/// The same over the top of a sphere about the origin.
std::vector<Vector3d> on_sphere(const std::vector<Vector3d>& flat) {
  std::vector<Vector3d> tool;
  for (const Vector3d& p : flat) {
    tool.emplace_back((kSphere + p.y()) * Vector3d(p.x(), kSphere, p.z()).normalized());
  }
  return tool;
}

struct Noise {
  double pose{2e-4}, memory{0.9}, force{0.01};
};

/// Recording of these contacts.
ContactSamples recorded(const std::vector<Vector3d>& tool, const std::vector<Vector3d>& contact,
                        const std::vector<Vector3d>& force, bool sphere, const Noise& noise,
                        RandomStream& random) {
  ContactSamples s;
  double drift = 0.0;
  for (std::size_t i = 1; i < tool.size(); ++i) {
    const Vector3d n = sphere ? Vector3d(contact[i].normalized()) : Vector3d(Vector3d::UnitY());
    drift = noise.memory * drift +
            std::sqrt(1.0 - noise.memory * noise.memory) * noise.pose * random.normal();
    s.time.push_back(static_cast<double>(i) * kPeriod);
    s.position.push_back(contact[i]);
    s.velocity.emplace_back((contact[i] - contact[i - 1]) / kPeriod);
    s.normal.push_back(n);
    s.force.emplace_back(force[i] +
                         noise.force * Vector3d(random.normal(), random.normal(), random.normal()));
    s.depth.push_back((sphere ? kSphere - tool[i].norm() : -tool[i].y()) + drift);
  }
  return s;
}

ContactSamples recorded(const std::vector<Vector3d>& tool, const std::vector<TrueContact>& truth,
                        bool sphere, const Noise& noise, RandomStream& random) {
  std::vector<Vector3d> contact, force;
  for (const TrueContact& c : truth) {
    contact.push_back(c.proxy);
    force.push_back(c.force);
  }
  return recorded(tool, contact, force, sphere, noise, random);
}

ContactSamples rubbed(double friction, bool sphere, std::uint64_t seed, const Noise& noise = {}) {
  RandomStream random(seed, "identification");
  const std::vector<Vector3d> flat = rubbing(random);
  if (sphere) {
    const std::vector<Vector3d> tool = on_sphere(flat);
    return recorded(tool, true_contacts(TrueSphere{kSphere}, tool, kStiffness, friction), true,
                    noise, random);
  }
  return recorded(flat, true_contacts(TruePlane{}, flat, kStiffness, friction), false, noise,
                  random);
}

constexpr int kTrials = 400;
/// 400 intervals of 95 % hold the truth in fewer than 365 with a probability of 0.0005.
constexpr int kFewestHolding = 365;

class IdentifyCoulombTest : public testing::TestWithParam<bool> {};

TEST_P(IdentifyCoulombTest, IntervalsHoldTheTruth) {
  int stiffness = 0, dynamic = 0, static_friction = 0;
  const double friction = 0.3;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto found =
        identify_contact(rubbed(friction, GetParam(), static_cast<std::uint64_t>(trial)));
    ASSERT_TRUE(found.dynamic_friction && found.static_friction) << trial;
    stiffness += found.stiffness.holds(kStiffness);
    dynamic += found.dynamic_friction->holds(friction);
    static_friction += found.static_friction->holds(friction);
    ASSERT_LT(found.dynamic_friction->high - found.dynamic_friction->low, 0.02);
    ASSERT_LT(found.static_friction->high - found.static_friction->low, 0.2);
    ASSERT_LT(found.stiffness.high, 2.0 * found.stiffness.low);
  }
  RecordProperty("stiffness", stiffness);
  RecordProperty("dynamic", dynamic);
  RecordProperty("static", static_friction);
  EXPECT_GE(stiffness, kFewestHolding);
  EXPECT_GE(dynamic, kFewestHolding);
  EXPECT_GE(static_friction, kFewestHolding);
}

TEST_P(IdentifyCoulombTest, RollingContactHasNoFriction) {
  int dynamic = 0, sticking = 0, static_friction = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto found = identify_contact(rubbed(0.0, GetParam(), static_cast<std::uint64_t>(trial)));
    ASSERT_TRUE(found.dynamic_friction);
    dynamic += found.dynamic_friction->holds(0.0);
    sticking += found.static_friction.has_value();
    static_friction += found.static_friction && found.static_friction->holds(0.0);
  }
  RecordProperty("dynamic", dynamic);
  RecordProperty("static_of_" + std::to_string(sticking), static_friction);
  EXPECT_GE(dynamic, kFewestHolding);
  EXPECT_GE(static_friction, sticking * kFewestHolding / kTrials);
}

INSTANTIATE_TEST_SUITE_P(Bodies, IdentifyCoulombTest, testing::Bool(),
                         [](const auto& sphere) { return sphere.param ? "Sphere" : "Plane"; });

/// The proxy knows two coefficients; the bodies of the analytic truth know one.
TEST(IdentifyContactTest, StaticAndDynamicFrictionAreToldApart) {
  const double side = 0.1;
  const geometry::Mesh plane{
      {{-side, 0.0, -side}, {-side, 0.0, side}, {side, 0.0, side}, {side, 0.0, -side}},
      {{0, 1, 2}, {0, 2, 3}}};
  const contact::ContactSurface surface(plane);
  RandomStream random(5, "identification");
  const std::vector<Vector3d> tool = rubbing(random);
  contact::Proxy proxy(surface, {.friction = {.static_friction = 0.6, .dynamic_friction = 0.25}});
  proxy.start(tool.front());
  std::vector<Vector3d> contact, force;
  for (const Vector3d& p : tool) {
    const contact::ProxyState& state = proxy.follow(p);
    contact.push_back(state.position);
    force.emplace_back(kStiffness * (state.position - p));
  }
  IdentificationOptions options;
  options.stick.slow = 1e-5;  // the proxy sticks without any motion; slower slip is no sticking
  const auto found =
      identify_contact(recorded(tool, contact, force, false, {0.0, 0.0, 0.0}, random), options);
  ASSERT_TRUE(found.static_friction && found.dynamic_friction);
  EXPECT_NEAR(found.dynamic_friction->value, 0.25, 0.005);
  EXPECT_NEAR(found.static_friction->value, 0.6, 0.03);
  EXPECT_TRUE(found.static_friction->holds(0.6));
  EXPECT_NEAR(found.stiffness.value, kStiffness, 1e-6 * kStiffness);
}

/// Recordings of eight paths, each with fifty runs of noise.
TEST(IdentifyContactTest, TextureIntervalsHoldTheAmplitude) {
  const double wavelength = 0.004;
  IdentificationOptions options;
  options.texture = TextureGrid{Vector3d::UnitX(), wavelength};
  for (const double height : {0.0, 2e-5, 1e-4}) {
    int held = 0, from_zero = 0;
    for (int path = 0; path < 8; ++path) {
      RandomStream random(static_cast<std::uint64_t>(path), "texture");
      const std::vector<Vector3d> tool = rubbing(random);
      const auto truth = height > 0.0
                             ? true_contacts(TrueWavyPlate{height, wavelength}, tool, kStiffness)
                             : true_contacts(TruePlane{}, tool, kStiffness);
      for (int trial = 0; trial < kTrials / 8; ++trial) {
        const auto found =
            identify_contact(recorded(tool, truth, false, {1e-4, 0.9, 0.01}, random), options);
        ASSERT_TRUE(found.texture);
        held += found.texture->holds(height);
        from_zero += found.texture->low == 0.0;
      }
    }
    RecordProperty("held_" + std::to_string(static_cast<int>(1e6 * height)) + "um", held);
    EXPECT_GE(held, kFewestHolding) << height;
    if (height == 1e-4) {
      EXPECT_LT(from_zero, kTrials / 100) << "0.1 mm stands out of 0.1 mm of noise";
    }
  }
}

/// One long stroke: nothing ever sticks.
TEST(IdentifyContactTest, WithoutAStickPhaseStaticFrictionIsNotIdentified) {
  RandomStream random(1, "stroke");
  std::vector<Vector3d> tool;
  for (int i = 0; i < kTicks; ++i) {
    const double t = i * kPeriod;
    tool.emplace_back(0.1 * t, 0.001 - 0.003 * std::min(1.0, 10.0 * t) - 0.0005 * std::sin(8.0 * t),
                      0.0);
  }
  const auto found = identify_contact(
      recorded(tool, true_contacts(TruePlane{}, tool, kStiffness, 0.3), false, {}, random));
  EXPECT_FALSE(found.static_friction);
  EXPECT_THAT(found.confounded, testing::Contains(HasSubstr("Static friction is not identifiable: "
                                                            "0 phases")));
  EXPECT_TRUE(found.dynamic_friction->holds(0.3)) << "a changing force tells friction from offset";
}

/// With the same force and direction throughout, friction looks like an offset of the sensor, and
/// stiffness like a shift of the body.
TEST(IdentifyContactTest, AnEvenStrokeFixesNeitherFrictionNorStiffness) {
  ContactSamples s;
  for (int i = 0; i < 1000; ++i) {
    s.time.push_back(i * kPeriod);
    s.position.emplace_back(0.1 * s.time.back(), 0.0, 0.0);
    s.velocity.emplace_back(0.1, 0.0, 0.0);
    s.normal.push_back(Vector3d::UnitY());
    s.force.emplace_back(-0.6, 2.0, 0.0);
    s.depth.push_back(0.002);
  }
  const auto found = identify_contact(s);
  EXPECT_TRUE(std::isinf(found.dynamic_friction->high));
  EXPECT_TRUE(std::isinf(found.stiffness.high));
  EXPECT_THAT(found.confounded, testing::Contains(HasSubstr("dynamic friction, force x")));
  EXPECT_THAT(found.confounded, testing::Contains(HasSubstr("compliance (1/stiffness), offset")));
}

/// A rigid body and noisy poses: no depth to see.
TEST(IdentifyContactTest, ARigidBodyHasNoUpperBoundOfStiffness) {
  RandomStream random(3, "rigid");
  ContactSamples s = rubbed(0.3, false, 3, {5e-4, 0.5, 0.01});
  double drift = 0.0;
  for (double& d : s.depth) {
    drift = 0.5 * drift + 4e-4 * random.normal();
    d = drift;
  }
  const auto found = identify_contact(s);
  EXPECT_GT(found.stiffness.low, 10.0 * kStiffness);
  EXPECT_TRUE(found.compliance.holds(0.0));
  EXPECT_TRUE(std::isinf(found.stiffness.high));
  EXPECT_THAT(found.confounded, testing::Contains(HasSubstr("has no upper bound")));
}

TEST(IdentifyContactTest, NoisyVelocitiesCannotTellSticking) {
  IdentificationOptions options;
  options.velocity_noise = 0.004;
  const auto found = identify_contact(rubbed(0.3, false, 1), options);
  EXPECT_FALSE(found.static_friction);
  EXPECT_THAT(found.confounded, testing::Contains(HasSubstr("velocities are good to 4 mm/s")));
}

TEST(IdentifyContactTest, RefusesWhatIsNoContact) {
  ContactSamples s = rubbed(0.3, false, 1);
  IdentificationOptions options;
  options.stick.slow = 0.02;
  EXPECT_THROW(identify_contact(s, options), std::invalid_argument);
  options = {};
  options.stick.least_force = 100.0;
  EXPECT_THROW(identify_contact(s, options), std::invalid_argument) << "nothing touches";
  s.depth.pop_back();
  EXPECT_THROW(identify_contact(s), std::invalid_argument);
}

TEST(PathVelocityTest, KnowsItsNoise) {
  RandomStream random(9, "path");
  std::vector<double> time;
  std::vector<Vector3d> path;
  const Vector3d truth(0.05, -0.02, 0.01);
  for (int i = 0; i < 3000; ++i) {
    time.push_back(i / 60.0);
    path.emplace_back(truth * time.back() +
                      5e-4 * Vector3d(random.normal(), random.normal(), random.normal()));
  }
  const PathVelocity found = path_velocity(time, path, 0.15);
  double squares = 0.0;
  for (const Vector3d& v : found.velocity) {
    squares += (v - truth).squaredNorm() / 3.0 / static_cast<double>(time.size());
  }
  EXPECT_NEAR(found.noise, std::sqrt(squares), 0.1 * found.noise);
  EXPECT_LT(found.noise, 0.006);
}

}  // namespace
}  // namespace haptrial::evaluation::identify_contact_test
