// The shapes of burrs, against formulas of solids of revolution and against their own outlines.

#include "core/bone/drill/burr_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::bone::burr_shape_test {
namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

const BurrDimensions kBall{BurrForm::kBall, 4e-3, 0.0, 0.0};
const BurrDimensions kFissure{BurrForm::kCylinder, 1.6e-3, 6e-3, 0.0};
const BurrDimensions kDisc{BurrForm::kCylinder, 6e-3, 1e-3, 0.0};
const BurrDimensions kTaper{BurrForm::kCone, 2e-3, 5e-3, 1.2e-3};
const BurrDimensions kSpike{BurrForm::kCone, 2e-3, 5e-3, 0.0};
const BurrDimensions kPear{BurrForm::kPear, 3e-3, 6e-3, 1.5e-3};
const BurrDimensions kRoundEnded{BurrForm::kPear, 2e-3, 7e-3, 2e-3};
const std::array kAll{kBall, kFissure, kDisc, kTaper, kSpike, kPear, kRoundEnded};

Vector3d random_place(RandomStream& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach),
          random.uniform(-reach, reach)};
}

TEST(BurrShapeTest, VolumesAreThoseOfTheFormulas) {
  const auto volume = [](const BurrDimensions& d) { return BurrShape(d).volume(); };
  const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 1e-12 * b); };
  near(volume(kBall), kPi / 6.0 * std::pow(4e-3, 3));
  near(volume(kFissure), kPi * 0.8e-3 * 0.8e-3 * 6e-3);
  near(volume(kTaper), kPi / 3.0 * 5e-3 * (1e-6 + 1e-3 * 0.6e-3 + 0.36e-6));
  near(volume(kSpike), kPi / 3.0 * 5e-3 * 1e-6);
  near(volume(kRoundEnded), kPi * 1e-6 * 5e-3 + 4.0 / 3.0 * kPi * 1e-9);
}

TEST(BurrShapeTest, APearIsTheHullOfItsTwoBalls) {
  const BurrShape shape(kPear);
  const Vector3d low(0.0, 0.0, -3e-3 + 1.5e-3);
  const Vector3d high(0.0, 0.0, 3e-3 - 0.75e-3);
  RandomStream random(1, "pear");
  int inside = 0;
  constexpr int kPlaces = 40'000;
  for (int n = 0; n < kPlaces; ++n) {
    const Vector3d p = random_place(random, 3e-3);
    // The hull is all balls whose centre and radius lie between those of the two.
    double distance = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= 400; ++step) {
      const double t = step / 400.0;
      const double radius = 1.5e-3 + t * (0.75e-3 - 1.5e-3);
      distance = std::min(distance, (p - (low + t * (high - low))).norm() - radius);
    }
    const double found = shape.nearest(p).distance;
    ASSERT_NEAR(found, distance, 2e-6);
    inside += found <= 0.0 ? 1 : 0;
  }
  const double share = static_cast<double>(inside) / kPlaces;
  EXPECT_NEAR(share * std::pow(6e-3, 3), shape.volume(), 0.03 * shape.volume());
}

TEST(BurrShapeTest, TheNearestPointIsThatOfItsOutlineAndTheNormalIsTheGradient) {
  for (const BurrDimensions& dimensions : kAll) {
    const BurrShape shape(dimensions);
    const auto outline = shape.outline(2000);
    RandomStream random(2, "places");
    for (int n = 0; n < 300; ++n) {
      const Vector3d p = random_place(random, 1.5 * shape.reach());
      const Eigen::Vector2d flat(std::hypot(p.x(), p.y()), p.z());
      double least = std::numeric_limits<double>::infinity();
      for (const auto& part : outline) {
        for (std::size_t i = 0; i + 1 < part.size(); ++i) {
          const Eigen::Vector2d a(part[i].radius, part[i].z);
          const Eigen::Vector2d way = Eigen::Vector2d(part[i + 1].radius, part[i + 1].z) - a;
          const double t = std::clamp((flat - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
          least = std::min(least, (flat - a - t * way).norm());
        }
      }
      const BurrShape::Nearest near = shape.nearest(p);
      ASSERT_NEAR(std::abs(near.distance), least, 1e-8) << name_of(dimensions.form);
      ASSERT_NEAR(near.normal.norm(), 1.0, 1e-12);
      if (near.distance < -1e-5) {  // outside, edges have many normals
        // A step along the normal comes nearer by as much, but where two surfaces are as near.
        const double step = 1e-7;
        const double gained = shape.nearest(p + step * near.normal).distance - near.distance;
        ASSERT_NEAR(gained, step, 1e-3 * step) << name_of(dimensions.form) << " " << p.transpose();
      }
    }
  }
}

TEST(BurrShapeTest, SectionsReachAndBallsAreWithinIt) {
  for (const BurrDimensions& dimensions : kAll) {
    const BurrShape shape(dimensions);
    const double half = shape.half_length();
    double volume = 0.0;
    double reach = 0.0;
    constexpr int kSlices = 20'000;
    for (int n = 0; n < kSlices; ++n) {
      const double z = half * (2.0 * (n + 0.5) / kSlices - 1.0);
      const double r = shape.radius_at(z);
      volume += kPi * r * r * 2.0 * half / kSlices;
      reach = std::max(reach, std::hypot(r, z));
      EXPECT_LE(r, 0.5 * dimensions.diameter * (1.0 + 1e-12));
      EXPECT_NEAR(shape.nearest({r, 0.0, z}).distance, 0.0, 1e-9);
    }
    EXPECT_NEAR(volume, shape.volume(), 1e-6 * volume);
    EXPECT_NEAR(reach, shape.reach(), 1e-3 * reach);
    EXPECT_NEAR(4.0 / 3.0 * kPi * std::pow(shape.ball_radius(), 3), volume, 1e-6 * volume);
    EXPECT_EQ(shape.radius_at(1.001 * half), 0.0);
    for (const BurrShape::Ball& ball : shape.balls()) {
      EXPECT_NEAR(-shape.nearest({0.0, 0.0, ball.z}).distance, ball.radius, 1e-9);
    }
    EXPECT_NEAR(shape.balls().front().radius - shape.balls().front().z, half, 1e-6)
        << "touches the tip";
  }
}

TEST(BurrShapeTest, ImpossibleDimensionsAreNamed) {
  EXPECT_THROW(BurrShape({BurrForm::kBall, 0.0, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(BurrShape({BurrForm::kCylinder, 2e-3, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(BurrShape({BurrForm::kCone, 2e-3, 5e-3, 3e-3}), std::invalid_argument);
  EXPECT_THROW(BurrShape({BurrForm::kCone, 2e-3, 5e-3, -1e-3}), std::invalid_argument);
  EXPECT_THROW(BurrShape({BurrForm::kPear, 2e-3, 2e-3, 1e-3}), std::invalid_argument);
  EXPECT_THROW(BurrShape({BurrForm::kPear, 2e-3, 5e-3, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::bone::burr_shape_test
