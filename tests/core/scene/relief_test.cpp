#include "core/scene/relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/scene/scene.h"
#include "tests/core/scene/spectrum.h"

namespace haptrial::scene::relief_test {
namespace {

using Eigen::Vector3d;
using haptrial::test::spectrum;

const Setting kSetting{10.0, 1000.0};

TEST(ReliefTest, BoundsOfSlopeAndCurvatureHoldAndAreNearlyReached) {
  const Grating sine({"floor", Vector3d::UnitX(), 2e-4, 0.003}, kSetting);
  GratingParameters soft{"floor", Vector3d::UnitX(), 2e-4, 0.003};
  soft.profile = GratingParameters::Profile::kRounded;
  const Grating rounded(soft, kSetting);
  for (const Grating* grating : {&sine, &rounded}) {
    double steepest = 0.0;
    double most_curved = 0.0;
    double before = 0.0;
    for (int i = 0; i < 30000; ++i) {
      ReliefHere relief;
      FieldState state;
      grating->add({1e-7 * i, 0.0, 0.0}, 1.0, relief, state);
      steepest = std::max(steepest, std::abs(relief.slope.x()));
      most_curved =
          std::max(most_curved, i == 0 ? 0.0 : std::abs(relief.slope.x() - before) / 1e-7);
      before = relief.slope.x();
      ASSERT_LE(std::abs(relief.height), 2e-4 * (1.0 + 1e-12));
    }
    EXPECT_LE(steepest, grating->steepest() * (1.0 + 1e-9));
    EXPECT_GE(steepest, 0.99 * grating->steepest());
    EXPECT_LE(most_curved, grating->most_curved() * (1.0 + 1e-6));
    EXPECT_GE(most_curved, 0.5 * grating->most_curved());
  }
}

TEST(ReliefTest, ATextureHasItsRoughnessAndBand) {
  // Along a line in the plane a wave of spatial frequency f is met with at most f.
  const Texture texture({"floor", Vector3d::UnitY(), 1e-4, 100.0, 400.0, 5}, kSetting);
  double squares = 0.0;
  constexpr int kPlaces = 40000;
  RandomStream random(1, "places");
  for (int i = 0; i < kPlaces; ++i) {
    ReliefHere relief;
    FieldState state;
    texture.add({random.uniform(-0.5, 0.5), random.uniform(), random.uniform(-0.5, 0.5)}, 1.0,
                relief, state);
    squares += relief.height * relief.height;
    ASSERT_LE(relief.slope.norm(), texture.steepest());
    ASSERT_NEAR(relief.slope.y(), 0.0, 1e-12) << "waves run across the normal";
  }
  EXPECT_NEAR(std::sqrt(squares / kPlaces), 1e-4, 2e-6);
  std::vector<double> line(2000);
  for (std::size_t i = 0; i < line.size(); ++i) {
    ReliefHere relief;
    FieldState state;
    texture.add({static_cast<double>(i) * 5e-4, 0.0, 0.0}, 1.0, relief,
                state);  // a metre: bins of 1/m
    line[i] = relief.height;
  }
  const std::vector<double> amplitude = spectrum(line);
  double above = 0.0;
  double all = 0.0;
  for (std::size_t k = 0; k < amplitude.size(); ++k) {
    all += amplitude[k] * amplitude[k];
    above += k > 405 ? amplitude[k] * amplitude[k] : 0.0;
  }
  EXPECT_LT(above, 1e-4 * all);
}

// Root mean squares over many places: of the slope, and of the Laplacian by differences of slopes.
TEST(ReliefTest, TheUsualSlopeAndCurvatureOfATextureAreItsRootMeanSquares) {
  const TextureParameters parameters{"floor", Vector3d::UnitY(), 1e-4, 100.0, 900.0, 5};
  const Texture texture(parameters, kSetting);
  const auto slope_at = [&](const Vector3d& p) {
    ReliefHere relief;
    FieldState state;
    texture.add(p, 1.0, relief, state);
    return relief.slope;
  };
  constexpr int kPlaces = 20000;
  constexpr double kAside = 1e-7;
  double slopes = 0.0, curvatures = 0.0;
  RandomStream random(1, "places");
  for (int i = 0; i < kPlaces; ++i) {
    const Vector3d p(random.uniform(-0.5, 0.5), 0.0, random.uniform(-0.5, 0.5));
    const Vector3d slope = slope_at(p);
    const double curvature = (slope_at(p + kAside * Vector3d::UnitX()).x() - slope.x() +
                              slope_at(p + kAside * Vector3d::UnitZ()).z() - slope.z()) /
                             kAside;
    slopes += slope.squaredNorm();
    curvatures += curvature * curvature;
  }
  const ReliefBound bound = parameters.relief_bound();
  EXPECT_NEAR(std::sqrt(slopes / kPlaces), bound.usual_slope, 0.03 * bound.usual_slope);
  EXPECT_NEAR(std::sqrt(curvatures / kPlaces), bound.usual_curvature, 0.03 * bound.usual_curvature);
  EXPECT_LT(bound.usual_slope, 0.3 * bound.slope);
}

/// A wall of 800 N/m with ridges of 0.2 mm every 2 mm, and a hand 3 mm deep whose place along them
/// is `x`. @returns the ticks on which the ridges count as a stimulus
std::vector<bool> meant_on(const std::function<double(double)>& x) {
  constexpr double kDt = 1e-3;
  const Field wall{"floor", SurfaceParameters{HalfSpace{}, false, {800.0, 0.0}}, 10.0, 0.0, 0.0};
  const GratingParameters ridges{"floor", Vector3d::UnitX(), 2e-4, 0.002};
  Scene scene({wall, {"ridges", ridges, 10.0, 0.0, 0.0}}, 1.0 / kDt);
  scene.switch_to(Scene::kAll);
  std::vector<bool> meant(1000);
  for (std::size_t i = 0; i < meant.size(); ++i) {
    const double t = kDt * static_cast<double>(i);
    const PointState hand{{x(t), -0.003, 0.0}, {(x(t) - x(t - kDt)) / kDt, 0.0, 0.0}};
    const Vector3d force = scene.force(hand);
    meant[i] = !scene.state(0).stimulus.isZero(0.0);
    if (meant[i]) {
      EXPECT_LT((scene.state(0).stimulus - (force - Vector3d(0.0, 2.4, 0.0))).norm(), 1e-12);
    }
  }
  return meant;
}

TEST(ReliefTest, AHandThatSwingsInAGrooveIsNoStimulus) {
  for (const double frequency : {4.0, 8.0, 15.0, 33.0, 84.0}) {
    const std::vector<bool> meant = meant_on([&](double t) {
      const double grown = std::clamp(t / 0.2, 0.0, 1.0);
      return 9e-4 * grown * std::sin(2.0 * std::numbers::pi * frequency * t);
    });
    EXPECT_EQ(std::ranges::count(meant, true), 0) << frequency << " Hz";
  }
  const std::vector<bool> still = meant_on([](double) { return 0.0; });
  EXPECT_EQ(std::ranges::count(still, true), 0);
}

TEST(ReliefTest, RidgesThatAHandPassesAreOneFromTheFirstOn) {
  for (const double a_second : {8.0, 15.0, 50.0, 100.0}) {
    const std::vector<bool> meant = meant_on([&](double t) { return 0.002 * a_second * t; });
    const auto first = static_cast<std::ptrdiff_t>(std::ceil(1000.0 / a_second));
    EXPECT_EQ(std::count(meant.begin() + first, meant.end(), false), 0) << a_second << " a second";
  }
}

TEST(ReliefTest, AHandThatTurnsBackStillPassesAndOneThatStopsDoesNot) {
  const std::vector<bool> turns =
      meant_on([](double t) { return 0.02 * std::sin(std::numbers::pi * t); });
  EXPECT_EQ(std::count(turns.begin() + 100, turns.end(), false), 0) << "it turns after 0.5 s";
  const std::vector<bool> stops = meant_on([](double t) { return 0.1 * std::min(t, 0.3); });
  EXPECT_TRUE(stops[400]);
  EXPECT_FALSE(stops[999]);
}

/// The ups through the mean height along 100 lines of a metre.
TEST(ReliefTest, ATextureHasAsManyRidgesAsItRises) {
  const Texture texture({"floor", Vector3d::UnitY(), 1e-4, 100.0, 400.0, 5}, kSetting);
  for (const Vector3d& way : {Vector3d(1.0, 0.0, 0.0), Vector3d(0.6, 0.0, 0.8)}) {
    int rises = 0;
    for (int line = 0; line < 100; ++line) {
      double before = 0.0;
      for (int i = 0; i <= 5000; ++i) {
        ReliefHere relief;
        FieldState state;
        texture.add(2e-4 * i * way + 0.37 * line * Vector3d(-way.z(), 0.0, way.x()), 1.0, relief,
                    state);
        rises += before < 0.0 && relief.height >= 0.0 ? 1 : 0;
        before = relief.height;
      }
    }
    EXPECT_NEAR(texture.ridges(way), rises / 100.0, 0.05 * texture.ridges(way));
  }
}

}  // namespace
}  // namespace haptrial::scene::relief_test
