// Recorded contact and its rendering.

#include "experiments/command/analysis/contact_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"

namespace haptrial::experiments {
namespace {

void take_contact_renderings(CLI::App& sub, EvaluateOptions& o) {
  sub.add_option("--renderer", o.renderers,
                 "Renderer: proxy, ruspini, penalty, voxel or distance-field; may be repeated or "
                 "joined by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  sub.add_option("--stiffness", o.stiffness, "Stiffness of every renderer [N/m] (default: 1000)");
  sub.add_option("--friction", o.friction,
                 "Friction coefficient of the proxies (default: the one that fits best)");
  sub.add_option("--rate", o.rate, "Ticks per second [Hz] (default: 1000)");
  sub.add_option("--resolution", o.resolution,
                 "Number of voxels along the longest axis (default: 64)");
  sub.add_option("--shading", o.shading,
                 "Force shading of the proxies over edges less sharp than this [degrees] (default: "
                 "none)");
  sub.add_option("--threshold", o.threshold,
                 "Position error from which a place is listed [mm] (default: 1)");
}

void take_contact_sensors(CLI::App& sub, EvaluateOptions& o) {
  sub.add_option("--tip", o.tip,
                 "Place of the tip in the tracked frame, x y z [mm] (default: 0 0 0)")
      ->expected(3);
  sub.add_option("--radius", o.radius, "Radius of the tip's sphere [mm] (default: 0)");
  sub.add_option("--sensor", o.sensor,
                 "Orientation of the force sensor in the tracked frame, as a quaternion w x y z "
                 "(default: 1 0 0 0)")
      ->expected(4);
  sub.add_option("--free", o.free,
                 "Stretch without contact, from and to [s], for the sensor's load; may be repeated "
                 "(default: the load is removed already)")
      ->expected(2, 200);
  sub.add_option("--load", o.load,
                 "Known load of the sensor, in place of --free: weight in the tracker's frame and "
                 "offset in the sensor's, x y z each [N]")
      ->expected(6);
  sub.add_option("--lag", o.lag, "Lag of the force's clock [ms] (default: estimated)");
  sub.add_flag("--registered", o.registered, "Take the poses to be in the mesh's frame");
  sub.add_flag("--on-body", o.on_body, "Take the forces to act on the body, not on the probe");
  sub.add_option("--grating", o.grating,
                 "Texture to identify: wavelength [mm] and axis x y z in the mesh's frame")
      ->expected(4);
}

}  // namespace

void add_evaluate(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "evaluate", "Compare renderings of a body with a recorded contact",
                 "haptrial evaluate poses.csv forces.csv --mesh body.stl --units mm --out out/body",
                 {"evaluation.json, report.html and its pictures in the folder of --out",
                  "algorithms/contact-evaluation.md"});
  auto& o = options_of<EvaluateOptions>(*sub, status, evaluate);
  sub->add_option("RECORDING", o.recording,
                  "Table of poses and forces (.csv), one table of each, a folder that holds "
                  "nothing else, or a session file (.h5) with recorded contacts")
      ->expected(1, 2);
  sub->add_option("--object", o.object,
                  "Object of a session file (default: the only one that was touched)");
  sub->add_option("--trial", o.trial,
                  "Trial of a session file (default: the first one in which it was touched)");
  sub->add_option(
         "--test-on", o.tested_on,
         "Another recording of the body with the same probe, a table, a folder or a session file, "
         "on which the "
         "friction is tested that fits RECORDING, and the other way round; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--mesh", o.mesh, "Mesh of the body (.obj, .ply, .stl)");
  sub->add_option("--units", o.units, "Unit of the mesh: m, cm or mm (default: m)");
  take_contact_renderings(*sub, o);
  take_contact_sensors(*sub, o);
  sub->add_flag("--simulated", o.simulated, "Mark the report as one of a simulated recording");
  sub->add_flag("--duck", o.duck,
                "Simulate a duck, its scan and a recording of it and make the source's tables "
                "anew, in place of RECORDING");
  sub->add_option("--seed", o.seed, "Seed of --duck (default: 1)");
  sub->add_option("--out", o.out, "New folder for the report, its pictures and the numbers");
}

}  // namespace haptrial::experiments
