#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/random.h"
#include "core/deformable/touch/energy_account.h"
#include "core/deformable/touch/normal_forces.h"
#include "core/deformable/touch/surface_samples.h"
#include "tests/core/deformable/touch/soft_block.h"

namespace haptrial::deformable::touch_parts_test {
namespace {

TEST(SurfaceSamplesTest, ASampleIsMadeOfCornersThatEachOfItsFacesHas) {
  const Compliance body(test::soft_block(), test::soft_tissue());
  for (const int steps : {1, 2, 5}) {
    const SurfaceSamples samples(body.faces(), body.rest(), steps);
    for (std::size_t f = 0; f < body.faces().size(); ++f) {
      const Face& face = body.faces()[f];
      for (const std::int32_t number : samples.on(static_cast<std::int32_t>(f))) {
        const SurfaceSamples::Sample& sample = samples.samples[static_cast<std::size_t>(number)];
        EXPECT_NEAR(sample.weight.sum(), 1.0, 1e-12);
        for (const std::int32_t corner : sample.corners) {
          EXPECT_TRUE(std::ranges::find(face, corner) != face.end())
              << "face " << f << ", sample " << number << ", " << steps << " steps";
        }
      }
    }
  }
}

/// The conditions themselves, for random matrices as near to singular as those of a surface.
TEST(NormalForcesTest, ForcesAndGapsAreNotNegativeAndNeverBoth) {
  RandomStream random(7, "places");
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 1 + static_cast<int>(random.below(PressedPlaces::kMost));
    Eigen::MatrixXd root(n, n);
    for (int i = 0; i < n * n; ++i) {
      root(i) = random.normal();
    }
    PressedPlaces places;
    places.compliance =
        1e-3 * (root * root.transpose() / n + 1e-4 * Eigen::MatrixXd::Identity(n, n));
    places.free_gap.resize(n);
    PressedPlaces::Vector force(n);
    for (int i = 0; i < n; ++i) {
      places.free_gap[i] = 1e-3 * random.normal();
      force[i] = random.uniform() < 0.5 ? 1.0 : 0.0;
    }
    ASSERT_TRUE(press(places, force)) << trial;
    const PressedPlaces::Vector gap = places.free_gap + places.compliance * force;
    EXPECT_GE(force.minCoeff(), 0.0);
    EXPECT_GE(gap.minCoeff(), -1e-9);
    EXPECT_LT(force.cwiseProduct(gap).cwiseAbs().maxCoeff(), 1e-8);
  }
}

using Eigen::Vector3d;

constexpr double kPeriod = 0.001;

/// Energy that a spring against a wall at 0 gives a hand beyond what the hand's damping takes, with
/// the force held over each tick [J].
double given_by_spring(double stiffness, bool with_account, double frequency) {
  EnergyAccount account;
  double given = 0.0, held = 0.0, before = -0.001;
  for (int i = 1; i < 2000; ++i) {
    const double at = -0.001 + 0.0004 * std::cos(2.0 * M_PI * frequency * kPeriod * i);
    const double way = at - before;
    given += held * way - EnergyAccount::kDamping * way * way / kPeriod;
    account.book({held, 0.0, 0.0}, {way, 0.0, 0.0}, kPeriod);
    held = -stiffness * at;
    held *= with_account ? account.share(held) : 1.0;
    before = at;
  }
  return given;
}

/// Colgate and Schenkel: held forces of a spring give energy if b < K T / 2, and most at half the
/// rate.
TEST(EnergyAccountTest, ASpringThatIsTooStiffForTheHandGivesNoMoreThanTheLoan) {
  const double bound = 2.0 * EnergyAccount::kDamping / kPeriod;
  EXPECT_LT(given_by_spring(0.9 * bound, false, 500.0), 0.0);
  EXPECT_GT(given_by_spring(1.1 * bound, false, 500.0), 1e-3);
  for (const double stiffness : {1.1, 5.0, 50.0}) {
    for (const double frequency : {500.0, 333.0, 120.0, 11.0}) {
      EXPECT_LT(given_by_spring(stiffness * bound, true, frequency), EnergyAccount::kLoan)
          << stiffness << " " << frequency;
    }
  }
}

TEST(EnergyAccountTest, AHandThatGaveGetsItsForceWhole) {
  EnergyAccount account;
  EXPECT_EQ(account.share(1.0), 1.0) << "a hand that rests may be pressed";
  account.book({0.0, 0.0, 0.0}, {0.0005, 0.0, 0.0}, kPeriod);
  account.open();
  EXPECT_LT(account.share(1.0), 0.02) << "nothing was given yet";
  account.book({-1.0, 0.0, 0.0}, {0.002, 0.0, 0.0}, kPeriod);
  EXPECT_NEAR(account.balance(), 0.002 + EnergyAccount::kDamping * 4e-6 / kPeriod, 1e-12);
  EXPECT_EQ(account.share(1.0), 1.0);
  account.open();
  EXPECT_EQ(account.balance(), 0.0);
}

}  // namespace

}  // namespace haptrial::deformable::touch_parts_test
