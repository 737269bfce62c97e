// Ratios of three constants, all over: what no search can go below on the source's gear.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/file_text.h"
#include "core/deformable/calibration/global_start.h"
#include "core/deformable/elements/setup_body.h"
#include "core/deformable/elements/static_solver.h"

namespace haptrial::deformable {
namespace {

class GearScanTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "results/calibration";
    const DeformSetup setup = read_setup(folder / "gear.toml");
    const geometry::TetMesh mesh = body_of(setup);
    const Elasticity elasticity = elasticity_of(setup, mesh);
    const ElasticBody elastic(mesh, elasticity);
    springs_ = spring_body(mesh, densities(elasticity, mesh.tetrahedra.size()),
                           UniformConstants{1.0, 1.0, 1.0});
    for (const SetupLoad& load : setup.loads) {
      if (load.name != "twist") {
        continue;
      }
      CalibrationLoad twist{load_case_of(setup, load, mesh), springs_.rest};
      const Vectors u = solve_static(elastic, twist.load).displacement;
      for (std::size_t v = 0; v < u.size(); ++v) {
        twist.reference[v] += u[v];
      }
      twist_ = {twist};
    }
  }

  /// The least share of the twist that any of the ratios leaves.
  double least(const SpringParameters& parameters, const RatioGrid& grid) const {
    const std::vector<SearchRange> ranges(3, {-20.0, 20.0});
    return global_starts(CalibrationProblem(springs_, twist_), parameters, ranges, grid)[0].left;
  }

  SpringBody springs_;
  std::vector<CalibrationLoad> twist_;
};

// The twist moves the gear by a five-hundredth of its width, so that the response at rest is the
// response. Equal constants leave a third of it, whatever they are; the source's 9 % is out of
// reach. Shared out by volume they leave less than half of that.
TEST_F(GearScanTest, NoThreeEqualConstantsFollowTheTwist) {
  const auto equal = SpringParameters::uniform(springs_);
  const RatioGrid grid{.decades = 3, .per_decade = 1};
  EXPECT_GT(least(equal, grid), 0.33);
  EXPECT_LT(least(equal.weighted(springs_, springs_.volumes), grid), 0.16);
}

/// Writes results/calibration/scan.csv where asked.
TEST_F(GearScanTest, TheScanIsWrittenWhereAsked) {
  if (std::getenv("HAPTRIAL_WRITE_RESULTS") == nullptr) {
    GTEST_SKIP() << "HAPTRIAL_WRITE_RESULTS=1 writes results/calibration/scan.csv";
  }
  const RatioGrid grid{.decades = 4, .per_decade = 4};
  const auto equal = SpringParameters::uniform(springs_);
  const auto folder = std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "results/calibration";
  write_text(
      folder / "scan.csv",
      fmt::format("share,ratios,least_left\nequal,1089,{:.4f}\nvolume,1089,{:.4f}\n",
                  least(equal, grid), least(equal.weighted(springs_, springs_.volumes), grid)));
}

}  // namespace
}  // namespace haptrial::deformable
