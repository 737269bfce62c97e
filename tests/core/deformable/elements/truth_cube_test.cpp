// A real cube of silicone: the inner beads between the end layers, which are moved as measured.

#include <gtest/gtest.h>

#include "core/deformable/calibration/marker.h"
#include "core/deformable/elements/static_solver.h"
#include "tests/support/shared_data.h"
#include "tests/support/truth_cube_body.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using test::TruthCube;

/// Root mean square distance of the inner beads from where elements put them [mm].
double bead_error(const TruthCube& cube, const test::CubeBody& body, const Vectors& u,
                  std::size_t state) {
  double squares = 0;
  int count = 0;
  Vectors moved(body.mesh.vertices.begin(), body.mesh.vertices.end());
  for (std::size_t v = 0; v < moved.size(); ++v) {
    moved[v] += u[v];
  }
  for (const TruthCube::Bead& bead : cube.beads) {
    if (bead.at_an_end()) {
      continue;
    }
    squares +=
        (place_of(marker_at(body.mesh, bead.rest, bead.moved[state]), moved) - bead.moved[state])
            .squaredNorm();
    ++count;
  }
  EXPECT_EQ(count, 245);
  return 1e3 * std::sqrt(squares / count);
}

class TruthCubeTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto file = test::shared_data("deformable/truth_cube_uniaxial_mm.csv");
    if (!file) {
      GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds the Truth Cube";
    }
    cube_ = test::read_truth_cube(*file);
    ASSERT_EQ(cube_.beads.size(), 343u);
  }

  /// Errors of the three states [mm].
  std::array<double, TruthCube::kStates> errors(Law law, std::int32_t across) const {
    constexpr int kDegree = 3;  // of the polynomials through the end layers, 49 beads each
    const test::CubeBody body = test::between_end_layers(cube_, across, kDegree);
    const ElasticBody elastic(body.mesh, Elasticity{{{15.3e3, 0.499, 980}}, {}, law});
    StaticSolver solver(elastic, {.tolerance = 1e-6});
    std::array<double, TruthCube::kStates> found{};
    for (std::size_t state = 0; state < TruthCube::kStates; ++state) {
      const StaticResult result = solver.solve(test::measured_ends(cube_, body, state, kDegree));
      found[state] = bead_error(cube_, body, result.displacement, state);
    }
    return found;
  }

  TruthCube cube_;
};

TEST_F(TruthCubeTest, TheFileRunsAlongTheAxesThatWeTake) {
  // Neighbours along i, j and k are about a centimetre apart along x, y and -z.
  for (const TruthCube::Bead& bead : cube_.beads) {
    const Vector3d expected(0.01 * (bead.place[0] - 4), 0.01 * (bead.place[1] - 4),
                            0.01 * (2.3 - bead.place[2]));
    EXPECT_LT((bead.rest - expected).norm(), 0.0055)
        << bead.place[0] << ' ' << bead.place[1] << ' ' << bead.place[2];
  }
}

TEST_F(TruthCubeTest, NeoHookeanElementsFindTheInnerBeads) {
  constexpr std::array<double, 3> kAllowed{0.34, 0.37, 0.41};  // [mm]; the beads' noise is 0.3
  const auto found = errors(Law::kNeoHookean, 8);
  for (std::size_t state = 0; state < TruthCube::kStates; ++state) {
    EXPECT_LT(found[state], kAllowed[state]) << state;
    EXPECT_LT(found[state], 0.95 * test::affine_error(cube_, state)) << state;
    EXPECT_GT(found[state], 0.29) << state << ": below the noise";
  }
}

TEST_F(TruthCubeTest, LawsOfSmallStrainsMissTheLargestOne) {
  const auto found = errors(Law::kCorotational, 8);
  EXPECT_GT(found[2], 1.5 * errors(Law::kNeoHookean, 8)[2]);
}

}  // namespace
}  // namespace haptrial::deformable
