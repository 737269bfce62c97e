#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/drill/burr.h"
#include "core/bone/drill/burr_shape.h"

namespace haptrial::bone {
namespace {

using ::testing::HasSubstr;

BurrParameters of_size(double diameter, double spacing) {
  BurrParameters p = default_burr(BurrKind::kCutting, diameter);
  p.sample_spacing = spacing;
  return p;
}

TEST(BurrTest, SamplesFillTheSphere) {
  for (const double diameter : {1e-3, 2.3e-3, 4e-3, 7e-3}) {
    const Burr burr(default_burr(BurrKind::kDiamond, diameter));
    const double volume = std::numbers::pi / 6.0 * std::pow(diameter, 3);
    const double cells = volume / std::pow(burr.parameters().sample_spacing, 3);
    EXPECT_NEAR(burr.samples(), cells, 0.01 * cells);
    EXPECT_NEAR(burr.samples() * burr.sample_volume(), volume, 1e-12 * volume);
    double second = 0.0;  // moment of a filled sphere: 3/5 r^2
    for (std::int32_t n = 0; n < burr.samples(); ++n) {
      EXPECT_LE(burr.position(n).norm(), burr.radius() * (1.0 + 1e-4));
      second += burr.position(n).squaredNorm() / burr.samples();
    }
    EXPECT_NEAR(second, 0.6 * burr.radius() * burr.radius(), 0.01 * burr.radius() * burr.radius());
  }
}

TEST(BurrTest, SevenMillimetresAtAQuarterAreElevenThousandSamples) {
  EXPECT_NEAR(Burr(of_size(7e-3, 0.25e-3)).samples(), 11500, 100);
}

TEST(BurrTest, EverySampleHasItsMirrorImage) {
  const Burr burr(of_size(4e-3, 0.3e-3));
  const Burr::Arrays a = burr.arrays();
  std::set<std::array<int, 6>> all;
  for (std::int32_t n = 0; n < a.count; ++n) {
    all.insert({a.x[n], a.y[n], a.z[n], a.dx[n], a.dy[n], a.dz[n]});
  }
  EXPECT_EQ(all.size(), static_cast<std::size_t>(a.count));
  for (const auto& s : all) {
    EXPECT_TRUE(all.contains({-s[0], -s[1], -s[2], -s[3], -s[4], -s[5]}));
  }
}

TEST(BurrTest, SamplesDoNotLieInLayers) {
  // Along any of these directions no thin slice holds more than a layer's share of the samples.
  const Burr burr(of_size(7e-3, 0.25e-3));
  for (const Eigen::Vector3d& along :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0)}) {
    std::array<int, 400> slices{};
    for (std::int32_t n = 0; n < burr.samples(); ++n) {
      const double at = along.normalized().dot(burr.position(n)) / burr.radius();
      ++slices[static_cast<std::size_t>(std::clamp(200.0 + 200.0 * at, 0.0, 399.0))];
    }
    // A slice of 1/400 through the middle has 3/2 of the mean; layers would have 14 times that.
    const double mean = burr.samples() / 400.0;
    EXPECT_LT(*std::max_element(slices.begin(), slices.end()), 3.0 * mean);
  }
}

TEST(BurrTest, DirectionsPointToTheCentre) {
  const Burr burr(of_size(4e-3, 0.3e-3));
  for (std::int32_t n = 0; n < burr.samples(); ++n) {
    EXPECT_NEAR(burr.direction(n).norm(), 1.0, 2e-4);
    EXPECT_NEAR(burr.direction(n).dot(-burr.position(n).normalized()), 1.0, 2e-4);
  }
}

TEST(BurrTest, PowerIsTheSourcesFormula) {
  const Burr burr(of_size(4e-3, 0.3e-3));
  const BurrParameters& p = burr.parameters();
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  for (std::int32_t n = 0; n < burr.samples(); ++n) {
    const double theta = std::acos(axis.dot(burr.position(n).normalized()));
    const double rate = p.removal_rate - p.falloff * std::abs(0.5 * std::numbers::pi - theta);
    EXPECT_NEAR(static_cast<double>(burr.power(n)), std::max(0.0, rate), 2e-3 * p.removal_rate);
  }
}

TEST(BurrTest, CuttingBurrsRemoveMoreAndDependMoreOnTheAngle) {
  const BurrParameters cutting = default_burr(BurrKind::kCutting, 4e-3);
  const BurrParameters diamond = default_burr(BurrKind::kDiamond, 4e-3);
  EXPECT_GT(cutting.removal_rate, diamond.removal_rate);
  EXPECT_GT(cutting.falloff, diamond.falloff);
}

TEST(BurrTest, ImpossibleParametersAreNamed) {
  BurrParameters p;
  p.diameter = 0.0;
  EXPECT_THROW(Burr{p}, std::invalid_argument);
  EXPECT_THROW(Burr(of_size(4e-3, 3e-3)), std::invalid_argument);
  EXPECT_THROW(Burr(of_size(7e-3, 1e-6)), std::invalid_argument);
  p = {};
  p.falloff = -1.0;
  EXPECT_THROW(Burr{p}, std::invalid_argument);
  p = {};
  p.removal_rate = std::nan("");
  EXPECT_THROW(Burr{p}, std::invalid_argument);
}

TEST(BurrTest, IsReadFromADefinition) {
  Table table = Table::parse("kind = 'cutting'\ndiameter = 0.002\nfalloff = 3\n", "a.toml");
  const BurrParameters p = burr_schema().read(table);
  table.finish();
  EXPECT_EQ(p.kind, BurrKind::kCutting);
  EXPECT_EQ(p.diameter, 0.002);
  EXPECT_EQ(p.falloff, 3.0);
  EXPECT_EQ(p.removal_rate, default_burr(BurrKind::kCutting, 0.002).removal_rate);
  EXPECT_NO_THROW(Burr{p});
}

TEST(BurrTest, EveryWrongKeyGetsASentence) {
  Table table = Table::parse(
      "kind = 'laser'\ndiameter = 4\nremoval_rate = -1\nrotation = 'left'\ncolour = 2\n", "a.toml");
  burr_schema().read(table);
  try {
    table.finish();
    FAIL() << "accepted";
  } catch (const InputError& error) {
    for (const char* part : {"a.toml:1: kind", "a.toml:2: diameter", "a.toml:3: removal_rate",
                             "a.toml:4: rotation", "a.toml:5: colour"}) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
}

}  // namespace
}  // namespace haptrial::bone

namespace haptrial::bone::burr_shape_test {
namespace {

// The shapes of burrs, against formulas of solids of revolution and against their own outlines.

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
      ASSERT_NEAR(std::abs(near.distance), least, 1e-8) << static_cast<int>(dimensions.form);
      ASSERT_NEAR(near.normal.norm(), 1.0, 1e-12);
      if (near.distance < -1e-5) {  // outside, edges have many normals
        // A step along the normal comes nearer by as much, but where two surfaces are as near.
        const double step = 1e-7;
        const double gained = shape.nearest(p + step * near.normal).distance - near.distance;
        ASSERT_NEAR(gained, step, 1e-3 * step)
            << static_cast<int>(dimensions.form) << " " << p.transpose();
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
