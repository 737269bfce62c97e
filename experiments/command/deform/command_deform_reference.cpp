#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/document/document.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/longest_of.h"
#include "core/base/nearest.h"
#include "core/deformable/elements/dynamic_solver.h"
#include "experiments/command/arguments.h"
#include "experiments/command/deform/deform_body.h"
#include "experiments/command/deform/deform_files.h"
#include "experiments/command/deform/deform_loads.h"
#include "experiments/command/deform/recorded_motion.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

struct DeformReferenceOptions {
  DeformInput input;
  std::string out;
  std::vector<std::string> loads;
  std::string model{"static"};
  std::optional<double> seconds;
  std::optional<double> step;
  std::optional<double> damping;
  bool motion{false};
  int frames{20};
  double tolerance{1e-8};
  std::string constants;
};

constexpr double kSeconds = 1.0;
constexpr double kStep = 1e-3;  // [s]
constexpr double kDamping = 0.0;

using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

/// Answer to one load.
struct Answer {
  std::string load;
  std::vector<Vector3d> displacement;
  Json numbers;
};

Answer statics(deformable::StaticSolver& solver, const NamedLoad& load) {
  const deformable::StaticResult found = solver.solve(load.load);
  return {load.load.name,
          found.displacement,
          {{"energy_J", found.energy},
           {"residual", found.residual},
           {"load_steps", found.load_steps},
           {"newton_steps", found.newton_steps}}};
}

Answer dynamics(const DeformBody& body, const deformable::ElasticBody& elastic,
                const NamedLoad& load, const DeformReferenceOptions& o, Progress& progress,
                double done) {
  deformable::DynamicOptions options;
  options.step = checked_real("--step", o.step.value_or(kStep), 1e-9, 10.0);
  options.mass_damping = checked_real("--damping", o.damping.value_or(kDamping), 0.0, 1e6);
  deformable::DynamicSolver solver(elastic, load.load.holds, options);
  std::vector<Vector3d> force(body.mesh.vertices.size(), Vector3d::Zero());
  for (const auto& nodal : load.load.forces) {
    force[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
  }
  const double seconds = checked_real("--seconds", o.seconds.value_or(kSeconds), options.step, 1e6);
  while (solver.time() < seconds - 0.5 * options.step) {
    solver.step(force);
    progress.update(done + solver.time() / seconds, load.load.name, 0.0);
    check_interrupt();
  }
  return {load.load.name,
          solver.motion().displacement,
          {{"time_s", solver.time()}, {"energy_J", solver.energy()}}};
}

/// The motion of elements by CVODE, and of springs with the constants of a file beside it.
Answer motion_of(const DeformBody& body, const deformable::ElasticBody& elastic,
                 const NamedLoad& load, const DeformReferenceOptions& o, exchange::NewFolder& out) {
  constexpr int kMostFrames = 100000;
  RecordedMotionOptions options;
  options.seconds = checked_real("--seconds", o.seconds.value_or(kSeconds), 1e-6, 1e6);
  options.frames = checked_number("--frames", o.frames, 1, kMostFrames);
  options.damping = checked_real("--damping", o.damping.value_or(kDamping), 0.0, 1e6);
  options.tolerance = checked_real("--tolerance", o.tolerance, 1e-13, 1e-2);
  std::optional<deformable::SpringBody> springs;
  if (!o.constants.empty()) {
    springs = springs_of(body, {1.0, 1.0, 1.0});
    springs->constants = read_constants(o.constants, *springs);
  }
  const RecordedMotion motion =
      recorded_motion(elastic, load.load, springs ? &*springs : nullptr, options);
  out.write(load.load.name + "-motion.csv", motion_csv(motion));
  const auto& last = motion.displacement.back();
  Answer answer{load.load.name,
                last,
                {{"time_s", motion.times.back()},
                 {"frames", motion.times.size()},
                 {"tolerance", options.tolerance},
                 {"motion_rms_m", motion.moved},
                 {"energy_J", elastic.energy(last)}}};
  if (motion.springs) {
    answer.numbers["springs_damping_per_s"] = motion.springs->damping;
    answer.numbers["springs_distance_m"] = motion.springs->distance;
    answer.numbers["springs_distance_same_damping_m"] = motion.springs->same;
  }
  return answer;
}

void print_damping(const Answer& answer) {
  if (!answer.numbers.contains("springs_damping_per_s")) {
    return;
  }
  fmt::print(
      "{}: springs come nearest with --damping {:.4g}: {:.4g} mm of {:.4g} mm of motion; {:.4g} mm "
      "with that of the elements\n",
      answer.load, answer.numbers["springs_damping_per_s"].get<double>(),
      1e3 * answer.numbers["springs_distance_m"].get<double>(),
      1e3 * answer.numbers["motion_rms_m"].get<double>(),
      1e3 * answer.numbers["springs_distance_same_damping_m"].get<double>());
}

/// Options that would be without effect.
void check_motion_options(const DeformReferenceOptions& o) {
  if (o.motion && o.model != "static") {
    throw InputError("--motion chooses its own steps; leave --model out");
  }
  const bool dynamic = o.model == "dynamic";
  if (o.step && !dynamic) {
    throw InputError("--step is for --model dynamic");
  }
  if ((o.seconds || o.damping) && !dynamic && !o.motion) {
    throw InputError(fmt::format("{} is for --model dynamic or --motion; a body at rest has none",
                                 o.seconds ? "--seconds" : "--damping"));
  }
}

std::string reference_report(const DeformBody& body, const std::vector<Answer>& answers,
                             bool simulated) {
  analysis::Document page;
  page.title = "Elements under loads";
  page.subtitle = body.setup.file.filename().string();
  page.simulated = simulated;
  page.paragraph(fmt::format("{} tetrahedra, {} vertices; {} law.", body.mesh.tetrahedra.size(),
                             body.mesh.vertices.size(), name_of(body.elasticity.law)));
  std::vector<std::vector<std::string>> rows;
  for (const Answer& answer : answers) {
    rows.push_back({answer.load, fmt::format("{:.6g}", 1e3 * root_mean_square(answer.displacement)),
                    fmt::format("{:.6g}", 1e3 * longest_of(answer.displacement)),
                    fmt::format("{:.6g}", answer.numbers["energy_J"].get<double>())});
  }
  page.table({"load", "root mean square of the vertices [mm]", "largest [mm]", "energy [J]"}, rows);
  page.source(body.setup.file.filename().string(), body.setup.text);
  return analysis::to_html(page);
}

std::string reference_json(const DeformBody& body, const std::vector<Answer>& answers,
                           bool simulated) {
  Json all{
      {"body", body.setup.file.filename().string()},      {"simulated", simulated},
      {"tetrahedra", body.mesh.tetrahedra.size()},        {"vertices", body.mesh.vertices.size()},
      {"law", std::string(name_of(body.elasticity.law))}, {"loads", Json::array()}};
  for (const Answer& answer : answers) {
    Json load{{"name", answer.load},
              {"rms_m", root_mean_square(answer.displacement)},
              {"largest_m", longest_of(answer.displacement)}};
    load.update(answer.numbers);
    all["loads"].push_back(load);
  }
  return all.dump(2) + "\n";
}

int deform_reference(const DeformReferenceOptions& options) {
  if (options.model != "static" && options.model != "dynamic") {
    throw InputError(
        not_allowed("--model", fmt::format("'{}'", options.model), {"static", "dynamic"}));
  }
  check_motion_options(options);
  const MemoryBudget budget(options.input.max_memory);
  const DeformBody body = load_deform_body(options.input);
  const auto loads = loads_of(body, options.loads);
  exchange::NewFolder out(options.out);
  const deformable::ElasticBody elastic(body.mesh, body.elasticity);
  std::optional<deformable::StaticSolver> solver;
  if (options.model == "static" && !options.motion) {
    solver.emplace(static_solver(body, elastic, budget));
  } else {
    check_memory_of(body, kByMovingElement, budget);
  }
  std::vector<Answer> answers;
  bool simulated = false;
  {
    Progress progress("elements", static_cast<double>(loads.size()));
    watch_for_interrupt();
    for (const NamedLoad& load : loads) {
      const auto done = static_cast<double>(answers.size());
      progress.update(done, load.load.name, 0.0);
      answers.push_back(options.motion ? motion_of(body, elastic, load, options, out)
                        : options.model == "static"
                            ? statics(*solver, load)
                            : dynamics(body, elastic, load, options, progress, done));
      simulated = simulated || load.simulated;
      const auto& u = answers.back().displacement;
      out.write(load.load.name + ".csv", displacements_csv(body.mesh, u));
      write_state(out.place(load.load.name + ".vtu"), body.mesh, u, elastic.states(u));
      progress.update(done + 1.0, load.load.name, 0.0);
      check_interrupt();
    }
  }
  out.write("reference.json", reference_json(body, answers, simulated));
  out.write("report.html", reference_report(body, answers, simulated));
  out.publish();
  if (simulated) {
    fmt::print("SIMULATED   loads from a simulated session\n");
  }
  for (const Answer& answer : answers) {
    fmt::print("{}: {:.6g} mm (root mean square), {:.6g} mm at most\n", answer.load,
               1e3 * root_mean_square(answer.displacement), 1e3 * longest_of(answer.displacement));
    print_damping(answer);
  }
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_deform_reference(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(
      deform, "reference", "Compute a body under its loads by finite elements",
      "haptrial deform reference gear.toml --out out/reference",
      {"displacements (.csv, .vtu), reference.json and report.html in the folder of --out",
       "guide-deformable.md"});
  auto& o = options_of<DeformReferenceOptions>(*sub, status, deform_reference);
  add_deform_input(*sub, o.input);
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--load", o.loads, "Name of a load; may be repeated (default: all)")
      ->allow_extra_args(false);
  sub->add_option("--model", o.model, with_default("Model: static or dynamic", o.model));
  sub->add_option("--seconds", o.seconds,
                  with_default("Duration of a dynamic model or a motion [s]", kSeconds));
  sub->add_option("--step", o.step, with_default("Step of a dynamic model [s]", kStep));
  sub->add_option("--damping", o.damping,
                  with_default("Damping by mass of a dynamic model or a motion [1/s]", kDamping));
  CLI::Option* motion =
      sub->add_flag("--motion", o.motion,
                    "Motion from rest under the load by SUNDIALS CVODE, to a stated tolerance");
  sub->add_option("--frames", o.frames, with_default("Number of frames of a motion", o.frames))
      ->needs(motion);
  sub->add_option("--tolerance", o.tolerance,
                  with_default("Relative tolerance of a motion", o.tolerance))
      ->needs(motion);
  sub->add_option("--constants", o.constants,
                  "Constants of springs from a calibration (.csv), whose damping is calibrated "
                  "against the motion")
      ->needs(motion);
}

}  // namespace haptrial::experiments
