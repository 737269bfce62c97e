// Springs calibrated to finite elements on the source's problem (Morris 2006, Figures 34 to 40): a
// gear 2 m wide, E 100 kPa, nu 0.45, its base held, 50 lb at two places of its front that twist it.
// Prints the table of docs/algorithms/deformable-calibration.md, and with --steps FILE the least
// error by evaluation [mm].
//
//     bench_calibration [--resolution N] [--seed N] [--steps FILE]

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/deformable/calibration/calibrate.h"
#include "core/deformable/elements/static_solver.h"
#include "core/geometry/mesh/mesh_bounds.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/voxelize.h"

namespace {

using Eigen::Vector3d;
using namespace haptrial::deformable;
using haptrial::geometry::TetMesh;

constexpr double kPounds50 = 222.411;  // [N]
const Material kMaterial{100e3, 0.45, 1000.0};

TetMesh make_body(int resolution) {
  const auto gear = haptrial::geometry::make_gear(
      {.teeth = 12, .tip_radius = 1.0, .root_radius = 0.8, .bore_radius = 0.3, .thickness = 0.6});
  const auto grid = haptrial::geometry::make_grid(haptrial::geometry::bounds(gear), resolution);
  return haptrial::geometry::tetrahedralize(
      haptrial::geometry::voxelize(gear, grid, haptrial::geometry::InsideRule::kParity));
}

std::int32_t nearest(const TetMesh& body, const Vector3d& place) {
  std::size_t best = 0;
  for (std::size_t v = 1; v < body.vertices.size(); ++v) {
    if ((body.vertices[v] - place).norm() < (body.vertices[best] - place).norm()) {
      best = v;
    }
  }
  return static_cast<std::int32_t>(best);
}

/// The lowest layer held; opposing forces at two places.
LoadCase load_of(const TetMesh& body, const std::string& name, const Vector3d& first,
                 const Vector3d& second, const Vector3d& force) {
  LoadCase load{name, {}, {}};
  double low = body.vertices[0].z();
  for (const auto& p : body.vertices) {
    low = std::min(low, p.z());
  }
  for (std::size_t v = 0; v < body.vertices.size(); ++v) {
    if (body.vertices[v].z() < low + 1e-6) {
      load.holds.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
    }
  }
  load.forces = {{nearest(body, first), force}, {nearest(body, second), -force}};
  return load;
}

CalibrationLoad answered(const ElasticBody& body, const LoadCase& load) {
  const StaticResult result = solve_static(body, load);
  CalibrationLoad answer{load, {}};
  for (std::size_t v = 0; v < result.displacement.size(); ++v) {
    answer.reference.emplace_back(body.mesh().vertices[v] + result.displacement[v]);
  }
  return answer;
}

struct Row {
  std::string what;
  CalibrationResult result;
  double seconds;
  double unseen;
};

Row calibrated(const std::string& what, const CalibrationProblem& seen,
               const CalibrationProblem& unseen, const SpringParameters& parameters,
               CalibrationSettings settings) {
  settings.ranges.assign(parameters.size(), {-3.0, 5.0});
  const auto begin = std::chrono::steady_clock::now();
  Row row{what, calibrate(seen, parameters, settings), 0.0, 0.0};
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!row.result.logarithms.empty()) {
    row.unseen = unseen.error(parameters.constants(row.result.logarithms), false).mean;
  }
  return row;
}

void print_row(const Row& row, double moved) {
  std::size_t unstable = 0, first = row.result.steps.size();
  for (std::size_t i = 0; i < row.result.steps.size(); ++i) {
    unstable += std::isinf(row.result.steps[i].error);
    if (row.result.steps[i].error < 1.05 * row.result.error && first > i) {
      first = i + 1;
    }
  }
  fmt::print("| {} | {} | {} | {} | {:.1f} | {:.4f} | {:.1f} % | {:.4f} |\n", row.what,
             row.result.steps.size(), first, unstable, row.seconds, 1e3 * row.result.error,
             100.0 * row.result.error / moved, 1e3 * row.unseen);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int resolution = 16;
  CalibrationSettings settings;
  std::string file;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--steps") {
      file = argv[i + 1];
    } else if (option == "--seed") {
      settings.seed = std::strtoull(argv[i + 1], nullptr, 10);
    } else if (option == "--resolution") {
      resolution = std::atoi(argv[i + 1]);
    }
  }
  settings.evaluations = 600;
  const TetMesh mesh = make_body(resolution);
  const ElasticBody body(mesh, {{kMaterial}, {}, Law::kNeoHookean, VolumeForm::kPatches});
  const auto box = [&] {
    Eigen::AlignedBox3d all;
    for (const auto& p : mesh.vertices) {
      all.extend(p);
    }
    return all;
  }();
  const double top = box.max().z(), wide = box.max().x();
  const CalibrationLoad twist =
      answered(body, load_of(mesh, "twist", {wide, 0.35 * wide, top}, {wide, -0.35 * wide, top},
                             {kPounds50, 0.0, 0.0}));
  const CalibrationLoad bend = answered(
      body, load_of(mesh, "bend", {0.0, wide, top}, {0.0, -wide, top}, {0.0, 0.0, kPounds50}));
  const SpringBody springs = spring_body(mesh, kMaterial.density, {1.0, 1.0, 1.0});
  const CalibrationProblem seen(springs, {twist}), unseen(springs, {bend});
  const double moved = distance_error(twist.reference, springs.rest);
  fmt::print(
      "{} tetrahedra, {} edges; twist moves the vertices by {:.4f} mm (root mean square), "
      "bend by {:.4f} mm\n",
      mesh.tetrahedra.size(), springs.parts.edges.size(), 1e3 * moved,
      1e3 * distance_error(bend.reference, springs.rest));
  const auto uniform = SpringParameters::uniform(springs);
  const auto grid = SpringParameters::on_grid(springs, {5, 5, 3});
  const double hand = seen.error(uniform.constants(std::vector<double>{2.0, 2.0, 2.0}), false).mean;
  fmt::print("all constants 100 J: {:.4f} mm\n", 1e3 * hand);
  fmt::print(
      "| way | evaluations | within 5 % after | unstable | seconds | error [mm] | of the "
      "motion | unseen load [mm] |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  std::vector<Row> rows;
  rows.push_back(calibrated("uniform, descent", seen, unseen, uniform, settings));
  print_row(rows.back(), moved);
  settings.method = CalibrationMethod::kAnnealing;
  rows.push_back(calibrated("uniform, annealing", seen, unseen, uniform, settings));
  print_row(rows.back(), moved);
  rows.push_back(calibrated("grid, annealing", seen, unseen, grid, settings));
  print_row(rows.back(), moved);
  settings.method = CalibrationMethod::kDescent;
  settings.evaluations = 200;
  rows.push_back(calibrated("grid, descent", seen, unseen, grid, settings));
  print_row(rows.back(), moved);
  if (!file.empty()) {
    std::ofstream out(file);
    for (const Row& row : rows) {  // the best so far, a block for each way
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < row.result.steps.size(); ++i) {
        best = std::min(best, row.result.steps[i].error);
        if (std::isfinite(best)) {
          out << i + 1 << ' ' << 1e3 * best << '\n';
        }
      }
      out << "\n\n";
    }
  }
  return 0;
}
