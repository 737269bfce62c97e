// A real cube of silicone by calibrated springs, beside elements and the affine map.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/files/file_text.h"
#include "core/deformable/calibration/calibrate.h"
#include "core/deformable/elements/static_solver.h"
#include "tests/support/shared_data.h"
#include "tests/support/truth_cube_body.h"

namespace haptrial::deformable {
namespace {

using test::TruthCube;

class TruthCubeSpringsTest : public testing::Test {
 protected:
  static constexpr int kDegree = 3;  // of the polynomials through the end layers

  void SetUp() override {
    const auto file = test::shared_data("deformable/truth_cube_uniaxial_mm.csv");
    if (!file) {
      GTEST_SKIP() << "the data of the Truth Cube are not there";
    }
    cube_ = test::read_truth_cube(*file);
    body_ = test::between_end_layers(cube_, 8, kDegree);
    springs_ = spring_body(body_.mesh, 980, {1, 1, 1});
    const ElasticBody elastic(body_.mesh, Elasticity{{{15.3e3, 0.499, 980}}});
    StaticSolver solver(elastic, {.tolerance = 1e-6});
    for (std::size_t state = 0; state < TruthCube::kStates; ++state) {
      CalibrationLoad by_elements{test::measured_ends(cube_, body_, state, kDegree), {}, {}};
      by_elements.reference = springs_.rest;
      const Vectors u = solver.solve(by_elements.load).displacement;
      for (std::size_t v = 0; v < u.size(); ++v) {
        by_elements.reference[v] += u[v];
      }
      CalibrationLoad by_beads = by_elements;
      for (const TruthCube::Bead& bead : cube_.beads) {
        if (!bead.at_an_end()) {
          by_beads.markers.push_back(marker_at(body_.mesh, bead.rest, bead.moved[state]));
        }
      }
      by_elements_.push_back(by_elements);
      by_beads_.push_back(by_beads);
    }
  }

  CalibrationResult found(const std::vector<CalibrationLoad>& loads,
                          const SpringParameters& parameters, long evaluations) const {
    CalibrationSettings settings;
    settings.ranges.assign(parameters.size(), {-5.0, 1.0});
    settings.evaluations = evaluations;
    settings.threads = 2;
    return calibrate(CalibrationProblem(springs_, loads), parameters, settings);
  }

  /// Errors of the inner beads in each state [mm].
  std::vector<double> bead_errors(const SpringConstants& constants) const {
    std::vector<double> errors;
    for (const CalibrationLoad& load : by_beads_) {
      errors.push_back(1e3 * CalibrationProblem(springs_, {load}).error(constants, false).mean);
    }
    return errors;
  }

  TruthCube cube_;
  test::CubeBody body_;
  SpringBody springs_;
  std::vector<CalibrationLoad> by_elements_, by_beads_;
};

TEST_F(TruthCubeSpringsTest, Explore) {
  const auto tell = [&](const char* what, const std::vector<CalibrationLoad>& loads,
                        const SpringParameters& p, long n) {
    const auto result = found(loads, p, n);
    fmt::print("{}: error {} after {}", what, 1e3 * result.error, result.steps.size());
    for (const double e : bead_errors(p.constants(result.logarithms))) fmt::print(" {:.4f}", e);
    if (p.size() == 3)
      fmt::print("  {} {} {}", result.logarithms[0], result.logarithms[1], result.logarithms[2]);
    fmt::print("\n");
    std::fflush(stdout);
  };
  const auto uniform = SpringParameters::uniform(springs_);
  tell("uniform by elements", by_elements_, uniform, 60);
  tell("uniform by beads 3", {by_beads_[2]}, uniform, 60);
  const auto grid = SpringParameters::on_grid(springs_, {3, 3, 3});
  tell("grid by elements", by_elements_, grid, 100);
  tell("grid by beads 3", {by_beads_[2]}, grid, 100);
  const auto grid5 = SpringParameters::on_grid(springs_, {5, 5, 4});
  tell("grid5 by elements", by_elements_, grid5, 100);
}

}  // namespace
}  // namespace haptrial::deformable
