#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "analysis/contact/demo_study/demo_study_report.h"
#include "analysis/contact/evaluation/check_body.h"
#include "analysis/contact/evaluation/evaluation_report.h"
#include "analysis/contact/recording/read_recording.h"
#include "analysis/contact/recording/session_contact.h"
#include "analysis/document/recorded_times.h"
#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/contact/renderer_kinds.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct EvaluateOptions {
  bool duck{false};
  std::string seed{"1"};
  std::vector<std::string> recording;
  std::vector<std::string> rendered;
  std::optional<std::string> object;
  std::optional<int> trial;
  std::vector<std::string> tested_on;
  std::string mesh;
  std::string units{"m"};
  std::vector<std::string> renderers;
  double stiffness{1000.0};
  std::optional<double> friction;
  double rate{1000.0};
  int resolution{64};
  std::optional<double> shading;
  std::vector<double> tip{0.0, 0.0, 0.0};
  std::optional<double> radius;
  std::vector<double> sensor{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
  std::vector<double> free;
  std::vector<double> load;
  std::optional<double> lag;
  bool registered{false};
  bool on_body{false};
  double threshold{1.0};
  std::vector<double> grating;
  bool simulated{false};
  std::string out;
};

namespace fs = std::filesystem;
using contact::RendererKind;

constexpr double kMilli = 1e-3;  // mm to m, ms to s
constexpr double kDegree = std::numbers::pi / 180.0;

double unit_of(const std::string& name) {
  if (name == "m") {
    return 1.0;
  }
  if (name == "cm" || name == "mm") {
    return name == "cm" ? 1e-2 : kMilli;
  }
  throw InputError(not_allowed("--units", fmt::format("'{}'", name), {"m", "cm", "mm"}));
}

std::vector<RendererKind> renderers_of(const std::vector<std::string>& words) {
  std::vector<RendererKind> kinds;
  std::vector<std::string> allowed;
  for (const contact::KindOfRenderer& kind : contact::kinds_of_renderer()) {
    std::string word = kind.word;  // one word on a command line
    std::replace(word.begin(), word.end(), ' ', '-');
    if (words.empty() || std::find(words.begin(), words.end(), word) != words.end()) {
      kinds.push_back(contact::renderer_kind(kind.word));
    }
    allowed.push_back(word);
  }
  for (const std::string& word : words) {
    if (std::find(allowed.begin(), allowed.end(), word) == allowed.end()) {
      throw InputError(not_allowed("--renderer", fmt::format("'{}'", word), allowed));
    }
  }
  return kinds;
}

Eigen::Vector3d unit_vector(const char* what, const Eigen::Vector3d& v) {
  if (!(v.norm() > 0.0) || !v.allFinite()) {
    throw InputError(
        fmt::format("{}: the axis has no length; allowed: three numbers, not all 0", what));
  }
  return v.normalized();
}

void take_sensors(const EvaluateOptions& o, evaluation::PrepareOptions& p) {
  p.radius = kMilli * checked_real("--radius", o.radius.value_or(0.0), 0.0, 1e3);
  p.tip = kMilli * Eigen::Vector3d(o.tip[0], o.tip[1], o.tip[2]);
  const Eigen::Quaterniond q(o.sensor[0], o.sensor[1], o.sensor[2], o.sensor[3]);
  if (!(std::abs(q.norm() - 1.0) <= 0.01)) {
    throw InputError(
        fmt::format("--sensor has the length {:.4g}; allowed: 0.99 to 1.01", q.norm()));
  }
  p.mount.orientation = q.normalized();
  if (o.free.size() % 2 != 0) {
    throw InputError(
        fmt::format("--free has {} times; allowed: pairs, from and to", o.free.size()));
  }
  for (std::size_t i = 0; i + 1 < o.free.size(); i += 2) {
    if (!(o.free[i] < o.free[i + 1])) {
      throw InputError(fmt::format("--free is from {} to {} s; allowed: an end after its beginning",
                                   o.free[i], o.free[i + 1]));
    }
    p.free.emplace_back(o.free[i], o.free[i + 1]);
  }
  if (!o.load.empty()) {
    if (!o.free.empty()) {
      throw InputError("--load stands beside --free; keep one of the two");
    }
    p.load = evaluation::SensorLoad{{o.load[0], o.load[1], o.load[2]},
                                    {o.load[3], o.load[4], o.load[5]}};
  }
  if (o.lag) {
    p.lag = kMilli * checked_real("--lag", *o.lag, -1e4, 1e4);
  }
  p.registered = o.registered;
  p.force_on_body = o.on_body;
}

evaluation::EvaluationOptions evaluation_options(const EvaluateOptions& o) {
  evaluation::EvaluationOptions e;
  take_sensors(o, e.prepare);
  e.renderers = renderers_of(o.renderers);
  e.prepare.stiffness = checked_real("--stiffness", o.stiffness, 1.0, 1e6);
  e.prepare.rate = checked_real("--rate", o.rate, 10.0, 1e5);
  e.resolution = checked_number("--resolution", o.resolution, 4, 512);
  e.threshold = kMilli * checked_real("--threshold", o.threshold, 0.0, 1e6);
  if (o.friction) {
    e.friction = checked_real("--friction", *o.friction, 0.0, 10.0);
  }
  if (o.shading) {
    e.crease_angle = kDegree * checked_real("--shading", *o.shading, 0.0, 90.0);
  }
  if (!o.grating.empty()) {
    e.texture = evaluation::TextureGrid{
        unit_vector("--grating", {o.grating[1], o.grating[2], o.grating[3]}),
        kMilli * checked_real("--grating", o.grating[0], 1e-3, 1e3)};
  }
  return e;
}

std::vector<fs::path> tables_of(const std::vector<std::string>& given) {
  if (given.size() != 1 || !fs::is_directory(given[0])) {
    return {given.begin(), given.end()};
  }
  std::vector<fs::path> tables;
  for (const fs::directory_entry& entry : fs::directory_iterator(given[0])) {
    if (entry.path().extension() == ".csv") {
      tables.push_back(entry.path());
    }
  }
  if (tables.empty() || tables.size() > 2) {
    throw InputError(
        fmt::format("{}: holds {} tables (.csv); allowed: one, or one of poses and one "
                    "of forces",
                    given[0], tables.size()));
  }
  std::sort(tables.begin(), tables.end());
  return tables;
}

evaluation::ContactRecording read_tables(const std::vector<std::string>& given) {
  std::vector<fs::path> tables = tables_of(given);
  if (tables.size() == 2) {
    const analysis::CsvTable first = analysis::CsvTable::load(tables[0]);
    if (first.has("force_x_N") || first.has("force_x_mN")) {
      std::swap(tables[0], tables[1]);
    }
  }
  return evaluation::read_recording(tables.front(), tables.back());
}

template <class Stream>
void warn_of_times(const char* what, const Stream& stream) {
  const double duration = stream.time.back() - stream.time.front();
  const analysis::RecordedTimes times{duration, static_cast<double>(stream.size() - 1) / duration};
  if (times.implausible()) {
    fmt::print(stderr, "WARNING: {} of {} ({}). {}\n", analysis::kImplausibleTimes, what,
               times.words(), analysis::kAreTheyMilliseconds);
  }
}

/// A recording, its names in a report and how it is prepared.
struct GivenRecording {
  evaluation::ContactRecording recording;
  evaluation::EvaluationNames names;
  evaluation::PrepareOptions prepare;
};

/// Reads the given recording; the streams of a session file have one clock and no load, and its
/// definition says how large the tool is.
/// @param prepare  as the options say
GivenRecording read_given(const EvaluateOptions& o, evaluation::PrepareOptions prepare) {
  const fs::path first(o.recording.front());
  evaluation::EvaluationNames names{first.filename().string(), fs::path(o.mesh).filename().string(),
                                    o.simulated, unit_of(o.units)};
  if (o.recording.size() > 1 || first.extension() != ".h5") {
    if (o.object || o.trial) {
      throw InputError("--object and --trial are for a session file (.h5)");
    }
    evaluation::ContactRecording recording = read_tables(o.recording);
    warn_of_times("poses", recording.pose);
    warn_of_times("forces", recording.force);
    return {std::move(recording), names, prepare};
  }
  evaluation::SessionContact contact =
      evaluation::read_session_contact(record::SessionReader(first), {o.object, o.trial});
  if (!o.radius) {
    prepare.radius = contact.tool_radius;
  }
  prepare.lag = prepare.lag.value_or(0.0);
  if (prepare.free.empty() && !prepare.load) {
    prepare.load = evaluation::SensorLoad{};
  }
  names.recording += fmt::format(", {} in trial {}", contact.object, contact.trial);
  names.simulated = names.simulated || contact.simulated;
  return {std::move(contact.recording), names, prepare};
}

/// Recordings of --test-on, each prepared as if it were given alone.
std::vector<evaluation::NamedRecording> read_others(const EvaluateOptions& o,
                                                    const evaluation::PrepareOptions& prepare) {
  std::vector<evaluation::NamedRecording> others;
  for (const std::string& path : o.tested_on) {
    EvaluateOptions other = o;
    other.recording = {path};
    other.trial.reset();
    if (fs::path(path).extension() != ".h5") {
      other.object.reset();
    }
    GivenRecording given = read_given(other, prepare);
    if (given.names.simulated && !o.simulated) {
      given.names.recording += " (simulated)";
    }
    others.push_back({given.names.recording, std::move(given.recording), given.prepare});
  }
  return others;
}

/// Forces of another program and its name: a row for each tick of contact.csv, which an earlier run
/// wrote.
struct Rendered {
  std::string file;
  std::string name;
  std::vector<Eigen::Vector3d> forces;
};

std::vector<Rendered> read_rendered(const std::vector<std::string>& files) {
  std::vector<Rendered> all;
  for (const std::string& file : files) {
    Rendered one{file, fs::path(file).stem().string(), {}};
    if (std::ranges::find(all, one.name, &Rendered::name) != all.end()) {
      throw InputError(fmt::format(
          "{}: another file of --rendered is called {}, too; give each a name of its own", file,
          one.name));
    }
    const auto table = analysis::CsvTable::load(file);
    std::array<std::vector<double>, 3> axes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i] = table.numbers(table.column(fmt::format("force_{}_N", "xyz"[i])));
    }
    for (std::size_t row = 0; row < table.rows(); ++row) {
      one.forces.emplace_back(axes[0][row], axes[1][row], axes[2][row]);
    }
    all.push_back(std::move(one));
  }
  return all;
}

/// @param found  without the file
evaluation::OtherRendering judged(const evaluation::Evaluation& found, Rendered rendered) {
  const std::vector<std::string> names = evaluation::force_names(found);
  if (std::ranges::find(names, rendered.name) != names.end()) {
    throw InputError(
        fmt::format("{}: contact.csv has forces called {}, too; give the file a name of its own",
                    rendered.file, rendered.name));
  }
  try {
    return evaluation::measured_forces(found.contact, rendered.name, std::move(rendered.forces));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", rendered.file, error.what()));
  }
}

int evaluate_demo_study(const EvaluateOptions& o) {
  if (!o.recording.empty() || !o.mesh.empty()) {
    throw InputError("--duck is given with a recording or a mesh; it makes its own");
  }
  if (!o.rendered.empty()) {
    throw InputError("--rendered needs RECORDING; --duck makes its own");
  }
  if (!o.tested_on.empty()) {
    throw InputError("--test-on needs RECORDING; --duck makes its own");
  }
  evaluation::DemoStudyOptions demo;
  demo.seed = checked_seed(o.seed);
  const evaluation::DemoStudyTables tables = evaluation::make_demo_study_tables(demo);
  const std::vector<evaluation::FailureMap> maps = evaluation::failure_maps();
  if (!o.out.empty()) {
    evaluation::write_demo_study(tables, maps, o.out);
  }
  for (const std::string& line : evaluation::demo_study_lines(tables, maps)) {
    fmt::print("{}\n", line);
  }
  return 0;
}

int evaluate(const EvaluateOptions& options) {
  if (options.duck) {
    return evaluate_demo_study(options);
  }
  if (options.seed != EvaluateOptions{}.seed) {
    throw InputError("--seed is for --duck; a recording has no random numbers");
  }
  if (options.recording.empty() || options.mesh.empty()) {
    throw InputError("evaluate needs RECORDING and --mesh, or --duck");
  }
  evaluation::EvaluationOptions chain = evaluation_options(options);
  const double unit = unit_of(options.units);
  const auto [recording, names, prepare] = read_given(options, chain.prepare);
  const std::vector<evaluation::NamedRecording> others = read_others(options, chain.prepare);
  chain.prepare = prepare;
  std::vector<Rendered> rendered = read_rendered(options.rendered);
  const contact::FeltBody body(load_mesh({options.mesh, unit, {}}, MemoryBudget({})));
  try {
    evaluation::check_body(body);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", options.mesh, error.what()));
  }
  evaluation::Evaluation found;
  try {
    found = evaluation::evaluate_rendering(recording, body, chain);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", options.recording.front(), error.what()));
  }
  if (!others.empty()) {
    try {
      evaluation::add_cross_fit(found, names.recording, others, body, chain);
    } catch (const std::invalid_argument& error) {
      throw InputError(error.what());
    }
  }
  for (Rendered& each : rendered) {
    found.others.push_back(judged(found, std::move(each)));
  }
  if (!options.out.empty()) {
    evaluation::write_evaluation(found, names, options.out);
  }
  if (names.simulated) {
    fmt::print("SIMULATED RECORDING\n");
  }
  for (const std::string& line : evaluation::evaluation_lines(found)) {
    fmt::print("{}\n", line);
  }
  if (!options.out.empty()) {
    fmt::print("report: {}\n", (fs::path(options.out) / "report.html").string());
  }
  return 0;
}

std::string words_of(const std::vector<double>& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

void add_renderer_options(CLI::App& sub, EvaluateOptions& o) {
  sub.add_option("--renderer", o.renderers,
                 "Renderer: proxy, ruspini, penalty, voxel or distance-field; may be repeated or "
                 "joined by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  sub.add_option("--stiffness", o.stiffness,
                 with_default("Stiffness of every renderer [N/m]", o.stiffness));
  sub.add_option("--friction", o.friction,
                 "Friction coefficient of the proxies (default: the one that fits best)");
  sub.add_option("--rate", o.rate, with_default("Ticks per second [Hz]", o.rate));
  sub.add_option("--resolution", o.resolution,
                 with_default("Number of voxels along the longest axis", o.resolution));
  sub.add_option("--shading", o.shading,
                 "Force shading of the proxies over edges less sharp than this [degrees] (default: "
                 "none)");
  sub.add_option("--threshold", o.threshold,
                 with_default("Position error from which a place is listed [mm]", o.threshold));
}

void add_sensor_options(CLI::App& sub, EvaluateOptions& o) {
  sub.add_option("--tip", o.tip,
                 with_default("Place of the tip in the tracked frame, x y z [mm]", words_of(o.tip)))
      ->expected(3);
  sub.add_option("--radius", o.radius,
                 "Radius of the tip's sphere [mm] (default: 0; of a session file the object's "
                 "tool_radius)");
  sub.add_option(
         "--sensor", o.sensor,
         with_default(
             "Orientation of the force sensor in the tracked frame, as a quaternion w x y z",
             words_of(o.sensor)))
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
                 {"evaluation.json, contact.csv, objects.toml, report.html and its pictures in the "
                  "folder of --out",
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
  sub->add_option("--rendered", o.rendered,
                  "Forces that another program gave for the in-trajectory of contact.csv, tick by "
                  "tick: force_x_N, force_y_N, force_z_N (.csv); may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--mesh", o.mesh, "Mesh of the body (.obj, .ply, .stl)");
  sub->add_option("--units", o.units, with_default("Unit of the mesh: m, cm or mm", o.units));
  add_renderer_options(*sub, o);
  add_sensor_options(*sub, o);
  sub->add_flag("--simulated", o.simulated, "Mark the report as one of a simulated recording");
  sub->add_flag("--duck", o.duck,
                "Simulate a duck, its scan and a recording of it and make the source's tables "
                "anew, in place of RECORDING");
  sub->add_option("--seed", o.seed, with_default("Seed of --duck", o.seed));
  sub->add_option("--out", o.out, "New folder for the report, its pictures and the numbers");
}

}  // namespace haptrial::experiments
