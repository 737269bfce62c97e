#include "experiments/definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/nearest.h"
#include "core/base/table.h"
#include "experiments/impossible.h"
#include "experiments/recorded_path.h"
#include "protocols/training_pass.h"

namespace haptrial::experiments {
namespace {

/// The loop of the device with the longest velocity window, so that the damping is safe with all.
control::HandleLoop handle_loop(const Setup& d) {
  control::HandleLoop loop;
  loop.handle_mass = d.hand.handle_mass;
  loop.rate = d.rate;
  loop.force_delay = d.device.force_delay;
  loop.velocity_window =
      std::max({2, d.device.velocity_window,
                static_cast<int>(std::lround(d.force_dimension.velocity_window * d.rate))});
  return loop;
}

constexpr double kLongestPass = 300.0;  // along x; the curve itself is a few times longer [s]

void check_path(Table& root, const Definition& d);

/// The conditions that planned tests may name. If the list of conditions is itself wrong, that
/// alone is a problem, so that every known one may be named.
std::vector<std::string> nameable(std::vector<std::string> conditions) {
  const auto& known = protocols::training_conditions();
  const bool good =
      std::set<std::string>(conditions.begin(), conditions.end()).size() == conditions.size() &&
      std::all_of(conditions.begin(), conditions.end(), [&known](const std::string& condition) {
        return std::find(known.begin(), known.end(), condition) != known.end();
      });
  if (!good) {
    conditions.insert(conditions.end(), known.begin(), known.end());
  }
  return conditions;
}

/// What no table can see alone.
void check_together(Table& root, const Definition& d) {
  const auto& known = protocols::training_conditions();
  Table design = root.table("design");
  for (const std::string& condition : d.design.conditions) {
    if (std::find(known.begin(), known.end(), condition) == known.end()) {
      const std::string hint = did_you_mean(condition, known);
      design.reject("conditions", fmt::format("is an array with '{}'{} allowed: {}", condition,
                                              hint.empty() ? ";" : hint, fmt::join(known, ", ")));
    }
  }
  Table guidance = root.table("guidance");
  if (d.guidance.force_limit > d.envelope.max_force) {
    guidance.reject("force_limit", fmt::format("{}", d.guidance.force_limit),
                    fmt::format("at most envelope.max_force, {} [N]", d.envelope.max_force));
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
    trajectory.reject(
        "speed", fmt::format("{}", d.trajectory.speed),
        fmt::format("at least {:.3g} [m/s], so that {} takes at most {} s", length / kLongestPass,
                    recorded ? "the recorded path" : "length_x", kLongestPass));
  }
  if (reach > d.envelope.workspace_radius) {
    const char* key = recorded ? "from" : "length_x";
    trajectory.reject(
        key, fmt::format("{} reaches {:.3g} m from the middle; keep it within "
                         "envelope.workspace_radius, {} [m]",
                         recorded ? "names a path that" : "gives, with range_z, a curve that",
                         reach, d.envelope.workspace_radius));
  }
  const double shortest = length / d.trajectory.speed;
  Table force_pattern = root.table("force_pattern");
  if (2.0 * d.force_pattern.ramp > shortest) {
    force_pattern.reject(
        "ramp", fmt::format("{}", d.force_pattern.ramp),
        fmt::format("at most half of the shortest pass, {:.3g} [s]", 0.5 * shortest));
  }
}

}  // namespace

Definition read_definition(Table& root, std::string_view file_name,
                           const std::filesystem::path* folder) {
  Table design = root.table("design");
  Table trajectory = root.table("trajectory");
  Table force_pattern = root.table("force_pattern");
  Table guidance = root.table("guidance");
  Table subject = root.table("subject");
  Table display = root.table("display");
  Table recording = root.table("recording");
  Table scoring = root.table("analysis");
  Definition d{read_setup(root, file_name),
               stimulus::read_trajectory_parameters(trajectory),
               stimulus::read_force_pattern_parameters(force_pattern),
               protocols::read_guidance_parameters(guidance),
               subject::Population(subject),
               std::nullopt,
               recording.number("stimulus_rate", {10.0, 10000.0}, "Hz"),
               analysis::read_score_parameters(scoring),
               {}};
  d.design = protocols::read_design(design);
  d.plan = analysis::read_analysis_plan(scoring, nameable(d.design.conditions));
  d.recovery = d.guidance.recovery;
  d.guidance.loop = handle_loop(d);
  d.display = render::read_trial_display_style(display);
  if (d.guidance.kind == protocols::Guidance::kCurve) {
    Table pace = root.table("pace");
    d.pace.emplace(pace);
    d.scoring.over_path = true;
  }
  if (folder != nullptr && !d.trajectory.from.empty()) {
    d.trajectory.points = recorded_path(d.trajectory.from, *folder);
  }
  check_setup(root, d);
  check_together(root, d);
  if (folder != nullptr) {
    reject_impossible(root, d);
  }
  root.finish();
  return d;
}

Definition load_definition(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  Table root = Table::load(file);
  return read_definition(root, file.string(), &folder);
}

Definition parse_definition(std::string_view text, std::string_view file_name) {
  Table root = Table::parse(text, file_name);
  return read_definition(root, file_name, nullptr);
}

}  // namespace haptrial::experiments
