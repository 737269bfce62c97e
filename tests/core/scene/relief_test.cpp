#include "core/scene/relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
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

}  // namespace
}  // namespace haptrial::scene::relief_test
