// Constants of springs found again from what they did, and from bodies that no springs are.

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/base/random.h"
#include "core/deformable/calibration/calibrate.h"
#include "core/deformable/calibration/global_start.h"
#include "core/deformable/calibration/made_loads.h"
#include "core/deformable/springs/equilibrium.h"
#include "core/deformable/springs/spring_grid.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

constexpr double kEdge = 0.01;  // [m]
constexpr double kDensity = 1000.0;

/// A block that stands on its bottom; `force` acts on its top [N].
LoadCase pressed(const SpringBody& body, const Vector3d& force) {
  LoadCase load{"press", {}, {}};
  double top = 0.0;
  for (const Vector3d& p : body.rest) {
    top = std::max(top, p.z());
  }
  std::vector<std::int32_t> upper;
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    if (body.rest[v].z() < 1e-9) {
      load.holds.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
    } else if (body.rest[v].z() > top - 1e-9) {
      upper.push_back(static_cast<std::int32_t>(v));
    }
  }
  for (const std::int32_t v : upper) {
    load.forces.push_back({v, force / static_cast<double>(upper.size())});
  }
  return load;
}

class CalibrationTest : public testing::Test {
 protected:
  /// Problem whose reference is the answer of springs with these constants.
  CalibrationProblem problem_of(const SpringConstants& truth,
                                const std::vector<Vector3d>& forces) const {
    SpringBody body = body_;
    body.constants = truth;
    std::vector<CalibrationLoad> loads;
    for (const Vector3d& force : forces) {
      const LoadCase load = pressed(body, force);
      const Equilibrium found = equilibrium(body, load);
      EXPECT_EQ(found.outcome, Settling::kSettled);
      loads.push_back({load, found.positions});
    }
    return {body_, loads};
  }
  SpringBody body_ = spring_body(test::solid_block({3, 3, 4}, kEdge), kDensity,  //
                                 UniformConstants{0.01, 0.01, 0.01});
  const std::vector<Vector3d> press_{{0.05, 0.0, -0.1}};
};

TEST_F(CalibrationTest, UniformAndGridSayTheSameConstants) {
  const std::vector<double> three{-2.0, -3.0, -1.5};
  const auto uniform = SpringParameters::uniform(body_).constants(three);
  const auto grid = SpringParameters::on_grid(body_, {2, 3, 2});
  std::vector<double> logarithms;
  for (const double x : three) {
    logarithms.insert(logarithms.end(), grid.size() / 3, x);
  }
  const auto same = grid.constants(logarithms);
  for (std::size_t i = 0; i < uniform.area.size(); ++i) {
    ASSERT_NEAR(same.area[i], uniform.area[i], 1e-15);
  }
  EXPECT_NEAR(uniform.length[0], 1e-2, 1e-15);
  EXPECT_NEAR(uniform.volume[0], std::pow(10.0, -1.5), 1e-15);
  EXPECT_EQ(uniform.length.size(), body_.parts.edges.size());
}

/// Each kind by a field of its own that the grid holds exactly, and its mean over the vertices.
TEST_F(CalibrationTest, AGridGivesAnElementTheMeanOfItsVertices) {
  const std::array<int, 3> nodes{3, 2, 2};
  const SpringGrid grid(body_, nodes);
  const auto parameters = SpringParameters::on_grid(body_, nodes);
  const auto field = [](double scale, const Vector3d& p) {
    return scale * (1.0 + 20.0 * p.x() + 5.0 * p.y() + 7.0 * p.z());
  };
  std::vector<double> logarithms;
  for (const double scale : {0.01, 0.03, 0.002}) {
    for (std::size_t i = 0; i < grid.used().size(); ++i) {
      logarithms.push_back(std::log10(field(scale, grid.place(i))));
    }
  }
  const auto found = parameters.constants(logarithms);
  const auto mean = [&](double scale, const auto& vertices) {
    double sum = 0.0;
    for (const std::int32_t v : vertices) {
      sum += field(scale, body_.rest[static_cast<std::size_t>(v)]);
    }
    return sum / static_cast<double>(vertices.size());
  };
  for (std::size_t i = 0; i < found.length.size(); ++i) {
    ASSERT_NEAR(found.length[i], mean(0.01, body_.parts.edges[i]), 1e-15);
  }
  for (std::size_t i = 0; i < found.area.size(); ++i) {
    ASSERT_NEAR(found.area[i], mean(0.03, body_.parts.faces[i]), 1e-15);
  }
  for (std::size_t i = 0; i < found.volume.size(); ++i) {
    ASSERT_NEAR(found.volume[i], mean(0.002, body_.tetrahedra[i]), 1e-15);
  }
}

TEST_F(CalibrationTest, EveryElementMayHaveItsOwnConstant) {
  const auto parameters = SpringParameters::by_element(body_);
  const SpringBody& b = body_;
  ASSERT_EQ(parameters.size(), b.lengths.size() + b.areas.size() + b.volumes.size());
  std::vector<double> logarithms(parameters.size(), -2.0);
  logarithms[b.lengths.size() + 3] = -1.0;
  const auto constants = parameters.constants(logarithms);
  EXPECT_NEAR(constants.area[3], 0.1, 1e-15);
  EXPECT_NEAR(constants.area[4], 0.01, 1e-15);
  EXPECT_NEAR(constants.volume.back(), 0.01, 1e-15);
}

/// Law: weighted by volume, the energy of lengths is a sum over tetrahedra, each with its six
/// edges.
TEST_F(CalibrationTest, WeightsMakeAnEvenDensityOfEnergy) {
  const auto parameters = SpringParameters::uniform(body_).weighted(body_, body_.volumes);
  SpringBody weighted = body_;
  weighted.constants = parameters.constants(std::vector<double>{-2.0, -300.0, -300.0});
  std::vector<Vector3d> moved = body_.rest;
  for (Vector3d& p : moved) {
    p += Vector3d(0.1 * p.y(), -0.05 * p.y(), 3.0 * p.x() * p.z());
  }
  double by_tetrahedra = 0.0;
  for (std::size_t t = 0; t < body_.tetrahedra.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const auto a = static_cast<std::size_t>(body_.tetrahedra[t][i]);
        const auto b = static_cast<std::size_t>(body_.tetrahedra[t][j]);
        const double rest = (body_.rest[a] - body_.rest[b]).norm();
        const double strain = (moved[a] - moved[b]).norm() / rest - 1.0;
        by_tetrahedra += body_.volumes[t] * 0.5 * strain * strain;
      }
    }
  }
  // The mean weight of an edge is its share of six times the volume.
  double volume = 0.0;
  for (const double v : body_.volumes) {
    volume += v;
  }
  const double mean = 6.0 * volume / static_cast<double>(body_.lengths.size());
  EXPECT_NEAR(spring_energy(weighted, moved), 0.01 * by_tetrahedra / mean,
              1e-12 * by_tetrahedra / mean);
}

/// The adjoint against central differences, for two loads and a grid, by each measure.
class GradientTest : public CalibrationTest, public testing::WithParamInterface<ErrorMeasure> {};

TEST_P(GradientTest, TheGradientIsThatOfTheError) {
  const auto parameters =
      SpringParameters::on_grid(body_, {2, 1, 2}).weighted(body_, body_.volumes);
  std::vector<double> truth(parameters.size(), -2.0);
  const CalibrationProblem made =
      problem_of(parameters.constants(truth), {{0.05, 0.0, -0.1}, {0.0, 0.1, 0.05}});
  const CalibrationProblem problem(body_, made.loads(), GetParam());
  RandomStream random(5, "place");
  std::vector<double> at;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    at.push_back(random.uniform(-2.3, -1.7));
  }
  const CalibrationError here = problem.error(parameters.constants(at), true);
  ASSERT_TRUE(std::isfinite(here.mean)) << here.unstable;
  const std::vector<double> gradient = parameters.gradient(at, here.gradient);
  constexpr double kStep = 1e-4;
  double largest = 0.0;
  for (const double g : gradient) {
    largest = std::max(largest, std::abs(g));
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto error_at = [&](double shift) {
      std::vector<double> shifted = at;
      shifted[i] += shift;
      return problem.error(parameters.constants(shifted), false).mean;
    };
    EXPECT_NEAR(gradient[i], (error_at(kStep) - error_at(-kStep)) / (2 * kStep), 1e-5 * largest);
  }
}

INSTANTIATE_TEST_SUITE_P(Measures, GradientTest,
                         testing::Values(ErrorMeasure::kVertices, ErrorMeasure::kShape,
                                         ErrorMeasure::kTool),
                         [](const auto& measure) { return std::string(name_of(measure.param)); });

/// A body that is turned and shifted as a whole has its shape; under a force that shifts the
/// places where it acts along itself the error at the tool is that shift.
TEST_F(CalibrationTest, ShapeLetsRigidMotionPassAndTheToolFeelsItsWay) {
  CalibrationLoad load{pressed(body_, {0.0, 0.0, -0.1}), body_.rest};
  const Eigen::AngleAxisd turn(0.7, Vector3d(1.0, 2.0, -1.0).normalized());
  std::vector<Vector3d> turned, lower;
  for (const Vector3d& p : body_.rest) {
    turned.emplace_back(turn * p + Vector3d(0.1, 0.0, 0.3));
    lower.emplace_back(p + Vector3d(0.5, 0.0, -0.002));
  }
  EXPECT_GT(load_error(load, turned), 0.1);
  EXPECT_LT(load_error(load, turned, ErrorMeasure::kShape), 1e-12);
  EXPECT_NEAR(load_error(load, lower, ErrorMeasure::kTool), 0.002, 1e-12);
  EXPECT_NEAR(way_of_tool(load.load, body_.rest, lower), 0.002, 1e-12);
  load.load.forces.clear();
  EXPECT_THAT(test::message_of([&] { CalibrationProblem(body_, {load}, ErrorMeasure::kTool); }),
              testing::HasSubstr("load 'press' has no force"));
}

/// The reference is what springs of these ratios do, so that the first start is the truth.
TEST_F(CalibrationTest, TheGlobalStartFindsRatiosAndScale) {
  const auto parameters = SpringParameters::uniform(body_);
  const ThreeLogarithms truth{-2.0, -1.0, -2.0};
  const CalibrationProblem problem =
      problem_of(parameters.constants(truth), {{0.01, 0.0, -0.02}, {0.0, 0.02, 0.0}});
  const std::vector<SearchRange> ranges(3, {-8.0, 4.0});
  const auto starts = global_starts(problem, parameters, ranges);
  ASSERT_EQ(starts.size(), 25u);
  EXPECT_LT(starts[0].left, 0.05);
  EXPECT_GT(starts[24].left, 0.1);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(starts[0].logarithms[i], truth[i], 0.03);
  }
}

/// The search keeps those constants, among all that came nearer to the followed load, that follow
/// the other loads best.
TEST_F(CalibrationTest, HeldOutLoadsDecideWhichConstantsAreKept) {
  const auto parameters = SpringParameters::on_grid(body_, {2, 2, 2});
  SpringBody uneven = body_;
  RandomStream random(3, "uneven");
  for (double& k : uneven.constants.length) {
    k *= std::pow(10.0, random.uniform(-1.0, 1.0));
  }
  const auto all = problem_of(uneven.constants, {{0.05, 0.0, -0.1}, {0.0, -0.05, 0.0}}).loads();
  const CalibrationProblem seen(body_, {all[0]}), held_out(body_, {all[1]});
  CalibrationSettings settings;
  settings.ranges.assign(parameters.size(), {-5.0, 1.0});
  settings.evaluations = 120;
  settings.held_out = &held_out;
  const CalibrationResult result = calibrate(seen, parameters, settings);
  const auto kept = held_out.error(parameters.constants(result.logarithms), false).mean;
  EXPECT_EQ(kept, result.held_out);
  double nearest = INFINITY;
  for (const CalibrationStep& step : result.steps) {
    EXPECT_GE(step.held_out, kept);
    nearest = std::min(nearest, step.error);
  }
  EXPECT_LT(nearest, result.error) << "the nearest to the followed load was not the best";
}

/// With forces as their own response, pushes on patches apart have nothing in common: one that was
/// given already is never made as long as there are others.
TEST_F(CalibrationTest, LoadsAreMadeWhereTheBodyIsLeastKnown) {
  geometry::TetMesh mesh;
  mesh.vertices.assign(body_.rest.begin(), body_.rest.end());
  mesh.tetrahedra.assign(body_.tetrahedra.begin(), body_.tetrahedra.end());
  const auto holds = common_holds(std::array{pressed(body_, {0.0, 0.0, -0.1})});
  const auto response = [&](const LoadCase& load) {
    std::vector<Vector3d> moved(body_.rest.size(), Vector3d::Zero());
    for (const NodalForce& nodal : load.forces) {
      moved[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
    return moved;
  };
  std::vector<Vector3d> along_x(body_.rest.size(), Vector3d(1e-3, 0.0, 0.0));
  const auto first = made_loads(mesh, holds, std::array{along_x}, 1, response);
  ASSERT_EQ(first.size(), 1u);
  const std::array given{along_x, response(first[0])};
  const auto more = made_loads(mesh, holds, given, 12, response);
  ASSERT_EQ(more.size(), 12u);
  for (const LoadCase& load : more) {
    double along = 0.0, largest = 0.0;
    const auto moved = response(load);
    for (std::size_t v = 0; v < moved.size(); ++v) {
      along += moved[v].dot(given[1][v]);
      largest = std::max(largest, moved[v].norm());
    }
    EXPECT_LT(along, 0.9 * std::inner_product(
                               moved.begin(), moved.end(), moved.begin(), 0.0, std::plus<>(),
                               [](const Vector3d& a, const Vector3d& b) { return a.dot(b); }))
        << load.name;
    EXPECT_NEAR(largest, 1e-3, 1e-12) << "as far as the given loads move a vertex";
    for (const NodalForce& nodal : load.forces) {
      EXPECT_GT(body_.rest[static_cast<std::size_t>(nodal.vertex)].z(), 1e-9) << "it is held";
    }
  }
}

/// Balanced forces name the constants at once, since the reference is what springs do.
TEST_F(CalibrationTest, TheStartIsTheTruthIfSpringsMadeTheReference) {
  const auto parameters = SpringParameters::uniform(body_);
  const std::vector<double> truth{-2.2, -1.9, -1.4};
  const CalibrationProblem problem = problem_of(parameters.constants(truth), press_);
  const std::vector<SearchRange> ranges(3, {-5.0, 1.0});
  const std::vector<double> start = starting_constants(problem, parameters, ranges);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(start[i], truth[i], 1e-4);
  }
}

TEST_F(CalibrationTest, DescentAndAnnealingFindWhatMadeTheReference) {
  const auto parameters = SpringParameters::uniform(body_);
  const std::vector<double> truth{-2.2, -1.9, -1.4};
  const CalibrationProblem problem = problem_of(parameters.constants(truth), press_);
  const double moved = distance_error(problem.loads()[0].reference, body_.rest);
  CalibrationSettings settings;
  settings.ranges.assign(3, {-4.0, 0.0});
  settings.enough = 1e-3 * moved;
  const CalibrationResult descent = calibrate(problem, parameters, settings);
  EXPECT_LE(descent.error, settings.enough);
  EXPECT_LE(descent.steps.size(), 20u);
  settings.method = CalibrationMethod::kAnnealing;
  settings.enough = 0.02 * moved;
  settings.evaluations = 1500;
  settings.threads = 2;
  const CalibrationResult annealed = calibrate(problem, parameters, settings);
  EXPECT_LE(annealed.error, settings.enough);
  EXPECT_GT(annealed.steps.size(), 100u);
}

/// Recorded steps are not done again, and the search goes on as it would have.
TEST_F(CalibrationTest, AnInterruptedAnnealingGoesOn) {
  const auto parameters = SpringParameters::uniform(body_);
  const CalibrationProblem problem =
      problem_of(parameters.constants(std::vector<double>{-2.2, -1.9, -1.4}), press_);
  CalibrationSettings settings;
  settings.method = CalibrationMethod::kAnnealing;
  settings.ranges.assign(3, {-4.0, 0.0});
  settings.annealing.samples = 20;
  settings.evaluations = 60;
  const CalibrationResult whole = calibrate(problem, parameters, settings);
  settings.known.assign(whole.steps.begin(), whole.steps.begin() + 37);
  std::size_t done = 0;
  settings.tell = [&](const CalibrationStep&) { ++done; };
  settings.threads = 2;
  const CalibrationResult resumed = calibrate(problem, parameters, settings);
  EXPECT_EQ(done, whole.steps.size() - 37);
  ASSERT_EQ(resumed.steps.size(), whole.steps.size());
  for (std::size_t i = 0; i < whole.steps.size(); ++i) {
    EXPECT_EQ(resumed.steps[i].logarithms, whole.steps[i].logarithms);
    EXPECT_EQ(resumed.steps[i].error, whole.steps[i].error);
  }
}

/// A pull that such soft springs cannot hold is named and not averaged in.
TEST_F(CalibrationTest, UnstableConstantsAreNamed) {
  const auto parameters = SpringParameters::uniform(body_);
  const CalibrationProblem problem =
      problem_of(parameters.constants(std::vector<double>{-2.0, -2.0, -2.0}), press_);
  const CalibrationError soft =
      problem.error(parameters.constants(std::vector<double>{-9.0, -9.0, -2.0}), true);
  EXPECT_TRUE(std::isinf(soft.mean));
  EXPECT_NE(soft.unstable.find("load 'press'"), std::string::npos);
}

TEST_F(CalibrationTest, BadInputGetsASentence) {
  EXPECT_EQ(test::message_of([&] { CalibrationProblem(body_, {}); }),
            "calibration: there is no load");
  const LoadCase load = pressed(body_, {0.0, 0.0, -0.1});
  EXPECT_EQ(test::message_of([&] {
              CalibrationProblem(body_, {{load, {}}});
            }),
            "load 'press': the reference has 0 vertices; the body has 80");
  const CalibrationProblem problem(body_, {{load, body_.rest}});
  CalibrationSettings settings;
  EXPECT_EQ(
      test::message_of([&] { calibrate(problem, SpringParameters::uniform(body_), settings); }),
      "calibration: 0 ranges are given for 3 parameters");
}

}  // namespace
}  // namespace haptrial::deformable
