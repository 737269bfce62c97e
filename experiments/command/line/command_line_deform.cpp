// Bodies that give way.

#include "experiments/command/deform/deform_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"

namespace haptrial::experiments {
namespace {

constexpr const char* kPage = "guide-deformable.md";

void take_deform_input(CLI::App& sub, DeformInput& input,
                       const char* what = "Definition of a body and its loads (.toml)") {
  sub.add_option("BODY", input.file, what)->required();
  sub.add_option("--max-memory", input.max_memory,
                 "Limit of memory [GB]; a larger body is refused (default: the free memory)");
}

void add_deform_info(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(deform, "info", "Describe a body: shapes, volume, mass, step, memory",
                             "haptrial deform info gear.toml", {"", kPage});
  auto& o = options_of<DeformInfoOptions>(*sub, status, deform_info);
  take_deform_input(*sub, o.input,
                    "Definition of a body (.toml), mesh (.obj, .ply, .stl) or tetrahedra (.node)");
  sub->add_option("--resolution", o.resolution,
                  "Number of cubes along the longest axis of a mesh (default: 20)");
  sub->add_option("--scale", o.scale, "Length of one unit of a mesh [m] (default: 1)");
  sub->add_option("--springs", o.constants,
                  "Constants of springs, of lengths, areas and volumes [J], whose stable step is "
                  "computed")
      ->expected(3);
}

void add_deform_reference(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(
      deform, "reference", "Compute a body under its loads by finite elements",
      "haptrial deform reference gear.toml --out out/reference",
      {"displacements (.csv, .vtu), reference.json and report.html in the folder of --out", kPage});
  auto& o = options_of<DeformReferenceOptions>(*sub, status, deform_reference);
  take_deform_input(*sub, o.input);
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--load", o.loads, "Name of a load; may be repeated (default: all)")
      ->allow_extra_args(false);
  sub->add_option("--model", o.model, "Model: static or dynamic (default: static)");
  sub->add_option("--seconds", o.seconds, "Duration of a dynamic model [s] (default: 1)");
  sub->add_option("--step", o.step, "Step of a dynamic model [s] (default: 0.001)");
  sub->add_option("--damping", o.damping, "Damping by mass [1/s] (default: 0)");
}

void add_deform_calibrate(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(
      deform, "calibrate", "Find the constants with which springs follow a reference",
      "haptrial deform calibrate gear.toml --out out/calibration",
      {"constants.csv, evaluations.csv, calibration.json and report.html in the folder of --out. "
       "A run that was killed goes on from OUT.evaluations",
       kPage});
  auto& o = options_of<DeformCalibrateOptions>(*sub, status, deform_calibrate);
  take_deform_input(*sub, o.input);
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--constants", o.constants,
                  "Constants to find: homogeneous, grid or elements (default: homogeneous)");
  sub->add_option("--grid", o.grid, "Nodes of the grid along x, y and z (default: 5 5 3)")
      ->expected(3);
  sub->add_option("--method", o.method, "Search: descent or annealing (default: descent)");
  sub->add_option(
      "--evaluations", o.evaluations,
      "Largest number of evaluations (default: 200 of a descent, 1000 of an annealing)");
  sub->add_option("--samples", o.samples, "Coarse samples of an annealing (default: 100)");
  sub->add_option("--batch", o.batch,
                  "Candidates of an annealing that are computed at once (default: 1)");
  sub->add_option("--range", o.range,
                  "Smallest and largest common logarithm of a constant [log10 J] (default: around "
                  "the material's)")
      ->expected(2);
  sub->add_option("--hand", o.hand,
                  "Constants set by hand, for comparison: lengths, areas and volumes [J] (default: "
                  "a power of ten near the material's)")
      ->expected(3);
  sub->add_option("--enough", o.enough, "Error at which the search ends [mm] (default: 0)");
  sub->add_option("--seed", o.seed, "Seed of an annealing (default: 1)");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
}

void add_deform_simulate(CLI::App& deform, int& status) {
  CLI::App* sub =
      subcommand(deform, "simulate", "Move a body in time or to rest",
                 "haptrial deform simulate gear.toml --springs 100 100 100 --out out/motion",
                 {"frames (.vtu, .csv) and series.pvd in the folder of --out", kPage});
  auto& o = options_of<DeformSimulateOptions>(*sub, status, deform_simulate);
  take_deform_input(*sub, o.input);
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--load", o.load, "Name of the load (default: the first)");
  sub->add_option("--model", o.model, "Model: springs or elements (default: springs)");
  sub->add_option("--constants", o.constants, "Constants of springs from a calibration (.csv)");
  sub->add_option("--springs", o.three, "Constants of springs: lengths, areas and volumes [J]")
      ->expected(3);
  sub->add_option("--seconds", o.seconds, "Duration [s] (default: 1)");
  sub->add_flag("--to-rest", o.to_rest, "End when the body rests, if that is sooner");
  sub->add_option("--frames", o.frames, "Number of frames over the duration (default: 20)");
  sub->add_option("--step", o.step,
                  "Step [s] (default: half the stable one of springs, 0.001 of elements)");
  sub->add_option("--damping", o.damping, "Damping by mass [1/s] (default: 20)");
}

void add_deform_skin(CLI::App& deform, int& status) {
  CLI::App* sub =
      subcommand(deform, "skin", "Move a fine surface with a body",
                 "haptrial deform skin gear.toml gear.ply out/reference/twist.csv --out out/skin",
                 {"a mesh for each state in the folder of --out", kPage});
  auto& o = options_of<DeformSkinOptions>(*sub, status, deform_skin);
  take_deform_input(*sub, o.input);
  sub->add_option("SURFACE", o.surface, "Surface (.obj, .ply, .stl)")->required();
  sub->add_option("STATES", o.states, "Displacements of the body's vertices (.csv)")->required();
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--scale", o.scale, "Length of one unit of the surface [m] (default: 1)");
  sub->add_option("--neighbours", o.neighbours,
                  "Number of vertices of the body that place one of the surface (default: 5)");
  sub->add_option("--format", o.format,
                  "Format of the meshes: ply, obj, stl or off (default: ply)");
}

}  // namespace

void add_deform(CLI::App& app, int& status) {
  CLI::App* deform = subcommand(app, "deform", "Compute, calibrate and move bodies that give way",
                                "haptrial deform info gear.toml", {"", kPage});
  deform->require_subcommand(1);
  add_deform_info(*deform, status);
  add_deform_reference(*deform, status);
  add_deform_calibrate(*deform, status);
  add_deform_simulate(*deform, status);
  add_deform_skin(*deform, status);
}

}  // namespace haptrial::experiments
