#include "core/bone/drill/burr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

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
