#include "experiments/definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/table.h"
#include "experiments/recorded_path.h"
#include "protocols/training_pass.h"

namespace haptrial::experiments {
namespace {

constexpr double kLongestPass = 300.0;  // along x; the curve itself is a few times longer [s]

void check_path(Table& root, const Definition& d);

/// What no table can see alone.
void check_together(Table& root, const Definition& d) {
  const auto& known = protocols::training_conditions();
  Table design = root.table("design");
  for (const std::string& condition : d.design.conditions) {
    if (std::find(known.begin(), known.end(), condition) == known.end()) {
      design.reject("conditions", fmt::format("an array with '{}'", condition),
                    fmt::format("{}", fmt::join(known, ", ")));
    }
  }
  Table guidance = root.table("guidance");
  if (d.guidance.force_limit > d.envelope.max_force) {
    guidance.reject("force_limit", fmt::format("{}", d.guidance.force_limit),
                    fmt::format("at most envelope.max_force, {} [N]", d.envelope.max_force));
  }
  Table envelope = root.table("envelope");
  if (d.envelope.max_force > d.device.max_force) {
    envelope.reject("max_force", fmt::format("{}", d.envelope.max_force),
                    fmt::format("at most device.max_force, {} [N]", d.device.max_force));
  }
  if (d.envelope.workspace_radius > d.device.workspace_radius) {
    envelope.reject(
        "workspace_radius", fmt::format("{}", d.envelope.workspace_radius),
        fmt::format("at most device.workspace_radius, {} [m]", d.device.workspace_radius));
  }
  const bool plain = std::all_of(d.name.begin(), d.name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  if (!plain) {
    root.table("experiment")
        .reject("name", fmt::format("'{}'", d.name), "letters, digits, '-' and '_'");
  }
  check_path(root, d);
}

/// The path and how long it takes.
void check_path(Table& root, const Definition& d) {
  if (!d.trajectory.from.empty() && d.trajectory.points.empty()) {
    return;  // a recorded path that is not read
  }
  Table trajectory = root.table("trajectory");
  const bool recorded = !d.trajectory.from.empty();
  double length = d.trajectory.length_x;  // at least
  double reach = 0.5 * std::hypot(d.trajectory.length_x, d.trajectory.range_z);
  if (recorded) {
    length = reach = 0.0;
    Eigen::Vector3d before = d.trajectory.points.front();
    for (const Eigen::Vector3d& point : d.trajectory.points) {
      length += (point - before).norm();
      reach = std::max(reach, point.norm());
      before = point;
    }
  }
  if (length / d.trajectory.speed > kLongestPass) {
    trajectory.reject("speed", fmt::format("{}", d.trajectory.speed),
                      fmt::format("so fast that {} takes at most {} s",
                                  recorded ? "the recorded path" : "length_x", kLongestPass));
  }
  if (reach > d.envelope.workspace_radius) {
    const char* key = recorded ? "from" : "length_x";
    trajectory.reject(
        key,
        recorded ? fmt::format("a path that reaches {:.3g} m from the middle", reach)
                 : fmt::format("{}", d.trajectory.length_x),
        fmt::format("{} within envelope.workspace_radius, {} [m]",
                    recorded ? "a path" : "with range_z, a curve", d.envelope.workspace_radius));
  }
  const double shortest = length / d.trajectory.speed;
  Table force_pattern = root.table("force_pattern");
  if (2.0 * d.force_pattern.ramp > shortest) {
    force_pattern.reject(
        "ramp", fmt::format("{}", d.force_pattern.ramp),
        fmt::format("at most half of the shortest pass, {:.3g} [s]", 0.5 * shortest));
  }
}

void read_devices(Table& root, Definition& d) {
  const auto read = [&root](const char* key, auto& into, auto reader) {
    if (root.has(key)) {
      Table table = root.table(key);
      into = reader(table);
    }
  };
  read("force_dimension", d.force_dimension, device::read_force_dimension_parameters);
  read("open_haptics", d.open_haptics, device::read_open_haptics_parameters);
  read("mouse", d.mouse, device::read_mouse_parameters);
}

/// @param folder  of the file, where a recorded path is to be read; else null
Definition read(Table root, std::string_view file_name, const std::filesystem::path* folder) {
  Table experiment = root.table("experiment");
  Table design = root.table("design");
  Table trajectory = root.table("trajectory");
  Table force_pattern = root.table("force_pattern");
  Table guidance = root.table("guidance");
  Table envelope = root.table("envelope");
  Table device = root.table("device");
  Table hand = root.table("hand");
  Table subject = root.table("subject");
  Table display = root.table("display");
  Table screen = root.table("screen");
  Table texts = root.table("texts");
  Table recording = root.table("recording");
  Table scoring = root.table("analysis");
  const bool cvode = hand.choice("integrator", {"exact", "cvode"}) == "cvode";
  Definition d{root.source(),
               std::filesystem::path(file_name).filename().string(),
               experiment.text("name"),
               experiment.number("rate", {100.0, 20000.0}, "Hz"),
               protocols::read_design(design),
               stimulus::read_trajectory_parameters(trajectory),
               stimulus::read_force_pattern_parameters(force_pattern),
               protocols::read_guidance_parameters(guidance),
               device::read_envelope_limits(envelope),
               device::read_virtual_device_parameters(device),
               subject::read_hand_parameters(hand),
               cvode ? Integrator::kCvode : Integrator::kExact,
               subject::Population(subject),
               std::nullopt,
               render::read_trial_display_style(display),
               read_screen_options(screen),
               read_session_texts(texts),
               recording.number("stimulus_rate", {10.0, 10000.0}, "Hz"),
               analysis::read_score_parameters(scoring)};
  read_devices(root, d);
  if (d.guidance.kind == protocols::Guidance::kCurve) {
    Table pace = root.table("pace");
    d.pace.emplace(pace);
    d.scoring.over_path = true;
  }
  if (folder != nullptr && !d.trajectory.from.empty()) {
    d.trajectory.points = recorded_path(d.trajectory.from, *folder);
  }
  check_together(root, d);
  root.finish();
  return d;
}

}  // namespace

Definition load_definition(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  return read(Table::load(file), file.string(), &folder);
}

Definition parse_definition(std::string_view text, std::string_view file_name) {
  return read(Table::parse(text, file_name), file_name, nullptr);
}

}  // namespace haptrial::experiments
