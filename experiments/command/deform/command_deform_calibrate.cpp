#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/fnv.h"
#include "core/base/nearest.h"
#include "core/deformable/springs/equilibrium.h"
#include "experiments/command/arguments.h"
#include "experiments/command/deform/calibration_loads.h"
#include "experiments/command/deform/calibration_report.h"
#include "experiments/command/deform/calibration_run.h"
#include "experiments/command/deform/deform_loads.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

struct DeformCalibrateOptions {
  DeformInput input;
  std::string out;
  std::string constants{"homogeneous"};
  std::vector<int> grid;
  std::string share{"material"};
  std::string measure{"vertices"};
  int made{0};
  std::string method{"descent"};
  std::optional<int> evaluations;
  std::optional<int> samples;
  int batch{1};
  std::vector<double> range;
  std::vector<double> hand;
  double enough{0.0};
  std::string seed{"1"};
  std::optional<int> jobs;
};

// Defaults of options that belong to one kind of constants or one method alone.
constexpr std::array kNodes{5, 5, 3};  // of --grid
constexpr int kSamples = 100;
constexpr int kDescent = 200;  // evaluations
constexpr int kAnnealing = 1000;
constexpr int kMostMade = 30;  // loads

namespace fs = std::filesystem;
using deformable::CalibrationLoad;
using deformable::CalibrationProblem;
using deformable::SpringBody;
using deformable::SpringParameters;
using Eigen::Vector3d;

/// The energy of a cube of the material as large as an edge: what constants are measured by.
double log_of_material(const DeformBody& body, const SpringBody& springs) {
  double length = 0.0;
  for (const double l : springs.lengths) {
    length += l / static_cast<double>(springs.lengths.size());
  }
  return std::log10(body.elasticity.materials[0].young * std::pow(length, 3));
}

deformable::SearchRange range_of(const DeformCalibrateOptions& o, double material) {
  constexpr double kBelow = 5.0, kAbove = 3.0;  // orders of magnitude
  if (o.range.empty()) {
    return {material - kBelow, material + kAbove};
  }
  constexpr double kMost = 30.0;
  const deformable::SearchRange range{checked_real("--range", o.range[0], -kMost, kMost),
                                      checked_real("--range", o.range[1], -kMost, kMost)};
  if (!(range.low < range.high)) {
    throw InputError(fmt::format("--range is from {} to {}; allowed: an end above its beginning",
                                 range.low, range.high));
  }
  return range;
}

std::array<int, 3> grid_of(const DeformCalibrateOptions& o) {
  return o.grid.empty() ? kNodes : std::array{o.grid[0], o.grid[1], o.grid[2]};
}

SpringParameters unshared_parameters(const DeformCalibrateOptions& o, const SpringBody& springs) {
  if (o.constants == "homogeneous") {
    return SpringParameters::uniform(springs);
  }
  if (o.constants == "grid") {
    const auto nodes = grid_of(o);
    return SpringParameters::on_grid(springs, {nodes[0], nodes[1], nodes[2]});
  }
  if (o.constants == "elements") {
    return SpringParameters::by_element(springs);
  }
  throw InputError(not_allowed("--constants", fmt::format("'{}'", o.constants),
                               {"homogeneous", "grid", "elements"}));
}

/// The volume of each tetrahedron times Young's modulus.
std::vector<double> stiffness_of(const DeformBody& body, const SpringBody& springs) {
  std::vector<double> stiffness = springs.volumes;
  const auto& elasticity = body.elasticity;
  for (std::size_t t = 0; t < stiffness.size(); ++t) {
    const std::size_t material = elasticity.material_of.empty() ? 0 : elasticity.material_of[t];
    stiffness[t] *= elasticity.materials[material].young;
  }
  return stiffness;
}

SpringParameters parameters_of(const DeformCalibrateOptions& o, const DeformBody& body,
                               const SpringBody& springs) {
  const SpringParameters parameters = unshared_parameters(o, springs);
  if (o.share == "equal") {
    return parameters;
  }
  if (o.share == "volume") {
    return parameters.weighted(springs, springs.volumes);
  }
  if (o.share == "material") {
    return parameters.weighted(springs, stiffness_of(body, springs));
  }
  throw InputError(
      not_allowed("--share", fmt::format("'{}'", o.share), {"equal", "volume", "material"}));
}

deformable::ErrorMeasure measure_of(const std::string& name) {
  std::vector<std::string> allowed;
  for (const auto measure : {deformable::ErrorMeasure::kVertices, deformable::ErrorMeasure::kShape,
                             deformable::ErrorMeasure::kTool}) {
    if (name == name_of(measure)) {
      return measure;
    }
    allowed.emplace_back(name_of(measure));
  }
  throw InputError(not_allowed("--measure", fmt::format("'{}'", name), allowed));
}

deformable::CalibrationMethod method_of(const std::string& name) {
  for (const auto method :
       {deformable::CalibrationMethod::kAnnealing, deformable::CalibrationMethod::kDescent}) {
    if (name == name_of(method)) {
      return method;
    }
  }
  throw InputError(not_allowed("--method", fmt::format("'{}'", name), {"annealing", "descent"}));
}

/// Options that would be without effect. Before anything is computed or written.
void check_together(const DeformCalibrateOptions& o) {
  const bool annealing = method_of(o.method) == deformable::CalibrationMethod::kAnnealing;
  if (o.constants != "grid" && !o.grid.empty()) {
    throw InputError("--grid is for --constants grid");
  }
  if (o.samples && !annealing) {
    throw InputError("--samples is for --method annealing");
  }
  if (o.samples && o.evaluations && *o.samples > *o.evaluations) {
    throw InputError(fmt::format("--samples is {}; allowed: up to --evaluations, {}", *o.samples,
                                 *o.evaluations));
  }
}

/// Another number for another body, reference or search; evaluations at most may grow.
std::uint64_t fingerprint(const DeformCalibrateOptions& o, const DeformBody& body,
                          const CalibrationRun& run, const std::vector<CalibrationLoad>& seen) {
  Fnv1a hash;
  hash.add(body.setup.text).add(o.method).add(o.constants).add(o.share).add(o.measure);
  hash.add(run.seed);
  const auto nodes = grid_of(o);
  for (const int n :
       {nodes[0], nodes[1], nodes[2], o.samples.value_or(kSamples), o.batch, o.made}) {
    hash.add(static_cast<std::uint64_t>(n));
  }
  const auto add = [&](std::span<const double> values) {
    hash.add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size_bytes()));
  };
  add(std::array{run.range.low, run.range.high});
  for (const CalibrationLoad& load : seen) {
    add({load.reference[0].data(), 3 * load.reference.size()});
    for (const auto& marker : load.markers) {
      add({marker.moved.data(), 3});
    }
  }
  return hash.value();
}

void search(const DeformCalibrateOptions& o, const CalibrationProblem& problem,
            const CalibrationProblem* held_out, const SpringParameters& parameters,
            CalibrationJournal& journal, CalibrationRun& run) {
  constexpr int kMost = 10000000;
  constexpr double kMilli = 1e-3;
  deformable::CalibrationSettings settings;
  settings.method = method_of(o.method);
  const bool annealing = settings.method == deformable::CalibrationMethod::kAnnealing;
  settings.ranges.assign(parameters.size(), run.range);
  settings.evaluations = checked_number(
      "--evaluations", o.evaluations.value_or(annealing ? kAnnealing : kDescent), 1, kMost);
  settings.annealing.samples = checked_number("--samples", o.samples.value_or(kSamples), 1, kMost);
  settings.annealing.batch = checked_number("--batch", o.batch, 1, 1000);
  settings.enough = kMilli * checked_real("--enough", o.enough, 0.0, 1e9);
  settings.seed = run.seed;
  settings.held_out = held_out;
  settings.threads = checked_jobs(o.jobs);
  settings.known = journal.known();
  run.earlier = settings.known.size();
  Progress progress("calibrating", static_cast<double>(settings.evaluations - run.earlier));
  double done = 0.0, best = INFINITY;
  for (const auto& step : settings.known) {
    best = std::min(best, step.error);
  }
  settings.tell = [&](const deformable::CalibrationStep& step) {
    journal.add(step);
    best = std::min(best, step.error);
    progress.update(++done, fmt::format("{:.4g} mm", best / kMilli), 0.0);
    check_interrupt();
  };
  const auto start = std::chrono::steady_clock::now();
  run.result = calibrate(problem, parameters, settings);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// How far the error changes if rest is asked for a hundred times tighter.
double tighter_change(const SpringBody& springs, const deformable::SpringConstants& constants,
                      const std::vector<CalibrationLoad>& seen) {
  constexpr double kTighter = 1e-12;  // of the largest force; calibration: 1e-10
  SpringBody body = springs;
  body.constants = constants;
  double most = 0.0;
  for (const CalibrationLoad& load : seen) {
    const auto first = equilibrium(body, load.load, {}, load.reference);
    const auto second = equilibrium(body, load.load, {kTighter, 200}, first.positions);
    most = std::max(
        most, std::abs(load_error(load, first.positions) - load_error(load, second.positions)));
  }
  return most;
}

std::array<double, 3> hand_of(const DeformCalibrateOptions& o, double material) {
  if (o.hand.empty()) {
    const double all = std::pow(10.0, std::floor(material));
    return {all, all, all};
  }
  constexpr double kMost = 1e30;
  return {checked_real("--hand", o.hand[0], 0.0, kMost),
          checked_real("--hand", o.hand[1], 0.0, kMost),
          checked_real("--hand", o.hand[2], 0.0, kMost)};
}

int deform_calibrate(const DeformCalibrateOptions& options) {
  check_together(options);
  measure_of(options.measure);
  const MemoryBudget budget(options.input.max_memory);
  const DeformBody body = load_deform_body(options.input);
  if (!options.out.empty() && fs::exists(options.out) && !fs::is_empty(options.out)) {
    throw InputError(fmt::format("{}: holds files; choose a new folder", options.out));
  }
  watch_for_interrupt();
  const std::vector<NamedLoad> loads = loads_of(body);
  const std::vector<AnsweredLoad> answered =
      answered_loads(body, loads, checked_number("--made", options.made, 0, kMostMade), budget);
  const std::vector<CalibrationLoad> seen = answers_of(answered, LoadPart::kSeen);
  const std::vector<CalibrationLoad> held_out = answers_of(answered, LoadPart::kHeldOut);
  check_memory_of(body, kBySpring, budget);
  const SpringBody springs = springs_of(body, {1.0, 1.0, 1.0});
  const double material = log_of_material(body, springs);
  CalibrationRun run;
  run.method = options.method;
  run.constants = options.constants;
  run.hand = hand_of(options, material);
  run.range = range_of(options, material);
  run.seed = checked_seed(options.seed);
  for (const NamedLoad& load : loads) {
    run.simulated = run.simulated || load.simulated;
  }
  run.share = options.share;
  run.measure = options.measure;
  const SpringParameters parameters = parameters_of(options, body, springs);
  const CalibrationProblem problem(springs, seen, measure_of(options.measure));
  std::optional<CalibrationProblem> judges;
  if (!held_out.empty()) {
    judges.emplace(springs, held_out, measure_of(options.measure));
  }
  const std::string out = fs::path(options.out).lexically_normal().string();
  const std::string kept =
      (out.ends_with('/') ? out.substr(0, out.size() - 1) : out) + ".evaluations";
  CalibrationJournal journal(kept, fingerprint(options, body, run, seen), parameters.size());
  try {
    search(options, problem, judges ? &*judges : nullptr, parameters, journal, run);
  } catch (const geometry::Cancelled&) {
    fmt::print(stderr, "haptrial: {} keeps the evaluations; the same command goes on from there\n",
               kept);
    throw;
  }
  if (run.result.logarithms.empty()) {
    throw InputError(
        fmt::format("no constants of {} rest under every load; the last: {}; raise "
                    "--evaluations or change --range",
                    run.result.steps.size(), run.result.steps.back().unstable));
  }
  run.springs = parameters.constants(run.result.logarithms);
  run.tighter = tighter_change(springs, run.springs, seen);
  judge_loads(answered, springs, spread(springs, {run.hand[0], run.hand[1], run.hand[2]}),
              checked_jobs(options.jobs), run);
  write_calibration(body, springs, run, options.out);
  journal.remove();
  if (run.simulated) {
    fmt::print("SIMULATED: loads from a simulated session\n");
  }
  for (const std::string& line : calibration_lines(run)) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n", (fs::path(options.out) / "report.html").string());
  return 0;
}

}  // namespace

void add_deform_calibrate(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(
      deform, "calibrate", "Find the constants with which springs follow a reference",
      "haptrial deform calibrate gear.toml --out out/calibration",
      {"constants.csv, evaluations.csv, calibration.json and report.html in the folder of --out. "
       "A run that was killed goes on from OUT.evaluations",
       "guide-deformable.md"});
  auto& o = options_of<DeformCalibrateOptions>(*sub, status, deform_calibrate);
  add_deform_input(*sub, o.input);
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--constants", o.constants,
                  with_default("Constants to find: homogeneous, grid or elements", o.constants));
  sub->add_option("--grid", o.grid,
                  with_default("Nodes of the grid along x, y and z",
                               fmt::format("{}", fmt::join(kNodes, " "))))
      ->expected(3);
  sub->add_option(
      "--share", o.share,
      with_default("Share of a spring in its number: equal, by the volume around it, or "
                   "by that volume's material (equal, volume, material)",
                   o.share));
  sub->add_option("--made", o.made,
                  with_default("Loads to make where the body is least known; every second one is "
                               "held out and decides which constants are kept",
                               o.made));
  sub->add_option(
      "--measure", o.measure,
      with_default("Error that is minimised: vertices, shape (rigid motion may pass) or "
                   "tool (the way of the forces)",
                   o.measure));
  sub->add_option("--method", o.method, with_default("Search: descent or annealing", o.method));
  sub->add_option(
      "--evaluations", o.evaluations,
      fmt::format("Largest number of evaluations (default: {} of a descent, {} of an annealing)",
                  kDescent, kAnnealing));
  sub->add_option("--samples", o.samples, with_default("Coarse samples of an annealing", kSamples));
  sub->add_option("--batch", o.batch,
                  with_default("Candidates of an annealing that are computed at once", o.batch));
  sub->add_option("--range", o.range,
                  "Smallest and largest common logarithm of a constant [log10 J] (default: around "
                  "the material's)")
      ->expected(2);
  sub->add_option("--hand", o.hand,
                  "Constants set by hand, for comparison: lengths, areas and volumes [J] (default: "
                  "a power of ten near the material's)")
      ->expected(3);
  sub->add_option("--enough", o.enough,
                  with_default("Error at which the search ends [mm]", o.enough));
  sub->add_option("--seed", o.seed, with_default("Seed of an annealing", o.seed));
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

}  // namespace haptrial::experiments
