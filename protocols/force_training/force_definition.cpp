#include "protocols/force_training/force_definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/base/counted.h"
#include "core/base/definition/schema.h"
#include "core/base/nearest.h"
#include "core/control/loop_margin.h"
#include "protocols/definition/lab_file.h"
#include "protocols/definition/mirroring.h"
#include "protocols/force_training/recorded_path.h"
#include "protocols/force_training/training_pass.h"

namespace haptrial::protocols {
namespace {

constexpr double kLongestPass = 300.0;  // along x; the curve itself is a few times longer [s]

void check_path(Table& root, const ForceDefinition& d);

/// The sampling theorem: at half the rate and above there is nothing left of a sinusoid.
void reject_frequencies(Table& root, const ForceDefinition& d) {
  const double nyquist = 0.5 * d.rate;
  if (d.force_pattern.max_frequency >= nyquist) {
    root.table("force_pattern")
        .reject("max_frequency", fmt::format("{:g}", d.force_pattern.max_frequency),
                fmt::format("below half of experiment.rate, {:g} [Hz]", nyquist));
  }
  const double along = d.trajectory.max_spatial_frequency * d.trajectory.speed;
  if (d.trajectory.from.empty() && along >= nyquist) {
    root.table("trajectory")
        .reject("max_spatial_frequency",
                fmt::format("{:g}, which is {:g} Hz at {:g} m/s",
                            d.trajectory.max_spatial_frequency, along, d.trajectory.speed),
                fmt::format("below half of experiment.rate, {:g} [Hz]", nyquist));
  }
  const double shortest = 2.0 / d.rate;
  if (d.force_pattern.bumps_max > 0 && d.force_pattern.bump_width_min < shortest) {
    root.table("force_pattern")
        .reject("bump_width_min", fmt::format("{:g}", d.force_pattern.bump_width_min),
                fmt::format("at least two ticks, {:g} [s]", shortest));
  }
}

/// Checks that no single table can make.
void check_together(Table& root, const ForceDefinition& d) {
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
  if (d.guidance.kind == Guidance::kCurve && (d.shows_expert() || d.guidance.free_recall)) {
    guidance.reject("kind", "'curve' with an expert or a free recall", "trajectory");
  }
  check_path(root, d);
}

/// The path and how long it takes.
void check_path(Table& root, const ForceDefinition& d) {
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

/// Gains that no hand carries would be reduced in every pass.
void reject_gains(Table& root, const ForceDefinition& d) {
  const control::HandleLoop loop = handle_loop(d);
  Table guidance = root.table("guidance");
  for (const auto& [name, gains] :
       {std::pair{"trajectory", d.guidance.trajectory}, {"plane", d.guidance.plane}}) {
    if (control::lightest_calm_hand(gains, loop) > control::kHeaviestHand) {
      guidance.reject(
          name, fmt::format("{:g} N/m and {:g} N·s/m", gains.stiffness, gains.damping),
          fmt::format(
              "what a hand of up to {:g} kg carries at {:g} Hz with forces that come {} late",
              control::kHeaviestHand, d.rate, control::ticks_in_words(loop.force_delay)));
    }
  }
}

/// Notes a number of trials that does not divide into blocks of each condition of some group.
void check_group_trials(Table& table, int trials, const ForceDefinition& d) {
  for (const auto& [group, conditions] : d.group_conditions) {
    check_trials(table, trials, d.design.repetitions, conditions.size(), " of the group " + group);
  }
}

/// The conditions of groups that have some of the design's alone.
void read_group_conditions(Table& root, ForceDefinition& d) {
  Table design = root.table("design");
  if (!design.has("group_conditions")) {
    return;
  }
  Table table = design.table("group_conditions");
  for (const std::string& group : table.keys()) {
    table.describe({group, "Conditions of the group NAME alone, of design.conditions",
                    "design.conditions", true});
    check_groups(root, table, group, {group});
    std::vector<std::string> conditions = table.texts(group);
    for (const std::string& condition : conditions) {
      if (std::ranges::find(d.design.conditions, condition) == d.design.conditions.end()) {
        table.reject(
            group, fmt::format("an array with \"{}\"", condition),
            fmt::format("conditions of the design: {}", fmt::join(d.design.conditions, ", ")));
      }
    }
    if (!conditions.empty()) {
      d.group_conditions[group] = std::move(conditions);
    }
  }
}

/// The sessions, of which each may have a number of trials of its own; the design has the most.
void read_sessions(Table& root, ForceDefinition& d) {
  const int usual = d.design.trials;
  d.session_plans = read_session_plans(
      root, d.design.sessions, "a name at least", [&](Table& session, int number) {
        session.describe({"trials", "Number of trials of the session", "design.trials"});
        d.session_trials.resize(static_cast<std::size_t>(number), usual);
        d.session_trials.back() = session.integer_or("trials", usual, 1, 100000);
        check_trials(session, d.session_trials.back(), d.design.repetitions,
                     d.design.conditions.size());
        check_group_trials(session, d.session_trials.back(), d);
      });
  if (d.session_trials.empty()) {
    Table design = root.table("design");
    check_group_trials(design, usual, d);
  } else {
    d.design.trials = *std::ranges::max_element(d.session_trials);
  }
}

const Schema<ForceDefinition>& recording_schema() {
  static const auto schema =
      Schema<ForceDefinition>()
          .number("stimulus_rate", &ForceDefinition::stimulus_rate, {10.0, 10000.0}, "Hz",
                  "Samples a second at which trajectory and force pattern are kept")
          .required();
  return schema;
}

}  // namespace

ForceDefinition read_force_definition(Table& root, std::string_view file_name,
                                      const std::filesystem::path* folder) {
  Table design = root.table("design");
  Table trajectory = root.table("trajectory");
  Table force_pattern = root.table("force_pattern");
  Table guidance = root.table("guidance");
  Table subject = root.table("subject");
  Table display = root.table("display");
  Table recording = root.table("recording");
  root.leave("analysis");
  if (root.has("power")) {
    root.leave("power");  // of who simulates it
  }
  ForceDefinition d;
  d.population = subject::subject_schema().read(subject);
  d.protocol = kForceTraining;
  read_common(root, file_name, d);
  d.trajectory = stimulus::trajectory_schema().read(trajectory);
  d.force_pattern = stimulus::force_pattern_schema().read(force_pattern);
  d.guidance = guidance_schema().read(guidance);
  recording_schema().read(recording, d);
  d.design = design_schema().read(design);
  read_group_conditions(root, d);
  read_sessions(root, d);
  read_mirroring(design, d);
  d.recovery = d.guidance.recovery;
  d.display = render::trial_display_schema().read(display);
  if (d.guidance.kind == Guidance::kCurve) {
    Table pace = root.table("pace");
    d.pace = subject::pace_schema().read(pace);
  }
  if (d.guidance.free_recall) {
    Table path_memory = root.table("path_memory");
    d.paths = subject::path_memory_schema().read(path_memory);
  }
  if (!root.has("tutoring") || !root.table("tutoring").has("pause_buttons")) {
    d.tutoring.pause_buttons = ~std::uint32_t{0};  // buttons mean nothing else here
  }
  d.guidance.tutoring = d.tutoring;
  if (folder != nullptr && !d.trajectory.from.empty()) {
    d.trajectory.points = recorded_path(d.trajectory.from, *folder);
  }
  check_common(root, d);
  check_together(root, d);
  if (folder != nullptr) {
    reject_frequencies(root, d);
    reject_gains(root, d);
    reject_speed(root, d, "trajectory", "speed", d.trajectory.speed);
    reject_speed(root, d, "guidance", "approach_speed", d.guidance.approach_speed);
  }
  return d;
}

ForceDefinition load_force_definition(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  Table root = load_with_lab(file);
  ForceDefinition d = read_force_definition(root, file.string(), &folder);
  root.finish();
  return d;
}

ForceDefinition parse_force_definition(std::string_view text, std::string_view file_name) {
  Table root = Table::parse(text, file_name);
  ForceDefinition d = read_force_definition(root, file_name, nullptr);
  root.finish();
  return d;
}

Design ForceDefinition::design_of(int session, int participant) const {
  Design one = design;
  const std::string group = group_of(groups, participant);
  const auto at = static_cast<std::size_t>(session - 1);
  if (at < session_trials.size()) {
    one.trials = session_trials[at];
  }
  if (const auto own = group_conditions.find(group); own != group_conditions.end()) {
    one.conditions = own->second;
  }
  for (int earlier = 1; earlier < session; ++earlier) {
    one.practice = comes(earlier, group) ? 0 : one.practice;
  }
  return one;
}

std::vector<int> ForceDefinition::trainings_before(int session, int participant) const {
  std::vector<int> trainings;
  for (int earlier = 1; earlier < session; ++earlier) {
    if (session_plan(earlier).gives && comes(earlier, group_of(groups, participant))) {
      trainings.push_back(earlier);
    }
  }
  return trainings;
}

/// "session 1, pre-test: 18 trials without training, about 14 min"
static std::string describe_session(const ForceDefinition& d, int session) {
  const protocols::SessionPlan& plan = d.session_plan(session);
  const auto at = static_cast<std::size_t>(session - 1);
  const int trials = at < d.session_trials.size() ? d.session_trials[at] : d.design.trials;
  const double passes = plan.gives ? 1.0 : 0.5;  // of a trial's two
  return fmt::format(
      "session {}{}: {}{}{}, about {}", session, plan.name.empty() ? "" : ", " + plan.name,
      counted(trials, "trial", "trials"), plan.gives ? "" : " without training",
      plan.groups.empty() ? "" : fmt::format(", of {} alone", fmt::join(plan.groups, ", ")),
      planned_minutes(passes * d.longest(trials)));
}

std::vector<std::string> ForceDefinition::description() const {
  std::vector<std::string> lines{
      fmt::format("{}: {}{}, {} in {} of {}, {} {}, {} Hz", name,
                  counted(design.participants, "participant", "participants"),
                  design.sessions > 1 ? fmt::format(" with {} sessions each", design.sessions) : "",
                  counted(design.trials, "trial", "trials"),
                  counted(design.blocks(), "block", "blocks"), design.repetitions,
                  design.conditions.size() == 1 ? "condition" : "conditions",
                  fmt::join(design.conditions, ", "), rate),
      fmt::format("about {} per {}, breaks and pages not counted",
                  planned_minutes(longest(design.trials)),
                  design.sessions > 1 ? "session" : "participant")};
  for (int session = 1; design.sessions > 1 && session <= design.sessions; ++session) {
    lines.push_back(describe_session(*this, session));
  }
  for (std::string& line : margins()) {
    lines.push_back(std::move(line));
  }
  return lines;
}

bool ForceDefinition::shows_expert() const {
  return std::any_of(design.conditions.begin(), design.conditions.end(), has_expert);
}

std::vector<std::string> ForceDefinition::margins() const {
  return margins_of(guidance, handle_loop(*this));
}

std::vector<std::string> margins_of(const GuidanceParameters& guidance,
                                    const control::HandleLoop& loop) {
  std::vector<std::string> lines;
  for (const auto& [which, gains] :
       {std::pair{"trajectory", guidance.trajectory}, {"plane", guidance.plane}}) {
    lines.push_back(describe(control::loop_margin(which, gains, loop)));
  }
  return lines;
}

double ForceDefinition::longest(int trials) const {
  // A wandering curve is about twice as long as its extent; approach and return take seconds.
  const double run = 2.0 * trajectory.length_x / trajectory.speed;
  const double around = guidance.wait + 2.0 * 1.875 * trajectory.length_x / guidance.approach_speed;
  return 2.0 * trials * (run + around);
}

}  // namespace haptrial::protocols
