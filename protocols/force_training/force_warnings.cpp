#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/definition/table.h"
#include "core/control/loop_margin.h"
#include "core/stimulus/stimulus.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/schedule.h"
#include "protocols/force_training/force_definition.h"

namespace haptrial::protocols {
namespace {

using Warnings = std::vector<std::string>;

void warn_of_loop(const ForceDefinition& d, Warnings& warnings) {
  for (const auto& [name, gains] :
       {std::pair{"trajectory", d.guidance.trajectory}, {"plane", d.guidance.plane}}) {
    const control::LoopMargin margin = control::loop_margin(name, gains, handle_loop(d));
    if (is_dangerous(margin)) {
      warnings.push_back(fmt::format(
          "guidance.{}.stiffness is {} N/m; a released handle oscillates above {:.0f} N/m at "
          "{} Hz, so that stiffness is reduced for it",
          name, gains.stiffness, margin.bare_stiffness, d.rate));
    } else if (margin.lightest > d.hand.hand_mass) {
      warnings.push_back(fmt::format(
          "guidance.{0}.damping is {1} N·s/m, which only a hand of {2} carries at {3} Hz; "
          "hand.hand_mass is {4} kg, so damping will be reduced in most passes",
          name, gains.damping,
          margin.lightest > control::kHeaviestHand
              ? fmt::format("more than {} kg", control::kHeaviestHand)
              : fmt::format("{:.2f} kg or more", margin.lightest),
          d.rate, d.hand.hand_mass));
    }
  }
}

/// The share of the pattern's time above a force, over the stimuli of the first seeds.
double share_above(const ForceDefinition& d, double force) {
  constexpr std::uint64_t kStimuli = 30;
  std::size_t above = 0;
  std::size_t all = 0;
  for (std::uint64_t seed = 1; seed <= kStimuli; ++seed) {
    const auto stimulus = stimulus::make_stimulus(d.trajectory, d.force_pattern, seed);
    constexpr double kStep = 0.01;  // [s]
    for (double t = 0.0; t < stimulus.path.duration(); t += kStep, ++all) {
      above += stimulus.force.at(t) > force ? 1 : 0;
    }
  }
  return static_cast<double>(above) / static_cast<double>(std::max<std::size_t>(1, all));
}

void warn_of_limit(const ForceDefinition& d, const char* key, double limit, Warnings& warnings) {
  if (!d.trajectory.from.empty() && d.trajectory.points.empty()) {
    return;  // a recorded path that is not read
  }
  // Guidance along the path takes part of the force: its drag and the friction.
  const double guidance = d.hand.damping * d.trajectory.speed + d.hand.coulomb_friction;
  const double left = std::sqrt(std::max(0.0, limit * limit - guidance * guidance));
  const double peak = std::max(d.force_pattern.base_max,
                               d.force_pattern.bumps_max > 0 ? d.force_pattern.bump_max : 0.0);
  constexpr double kFew = 0.005;  // of the pattern: not worth a warning
  const double cut = peak > left ? share_above(d, left) : 0.0;
  if (peak > limit || cut > kFew) {
    warnings.push_back(fmt::format(
        "{} is {} N; the force pattern reaches {} N, and guidance takes {:.2f} N: {:.1f} % of the "
        "pattern will be cut off",
        key, limit, peak, guidance, 100.0 * cut));
  }
}

/// Devices that the definition has a table for.
void warn_of_devices(const ForceDefinition& d, double reach, Warnings& warnings) {
  Table root = d.root();
  const auto check = [&](const std::string& table, double max_force, double workspace) {
    if (!root.has(table)) {
      return;
    }
    if (max_force < d.guidance.force_limit) {
      warn_of_limit(d, (table + ".max_force").c_str(), max_force, warnings);
    }
    if (workspace < reach) {
      warnings.push_back(
          fmt::format("{}.workspace_radius is {} m; the path reaches {:.3f} m from the middle, and "
                      "the device cannot follow it there",
                      table, workspace, reach));
    }
  };
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    const device::VendorDevice::Limits limits = vendor.limits(d.vendor);
    check(vendor.table, limits.max_force, limits.workspace_radius);
  }
}

/// A tenth of what the rate carries: from there on a tick is a step that is felt.
void warn_of_frequencies(const ForceDefinition& d, Warnings& warnings) {
  const double most = 0.05 * d.rate;
  const auto warn = [&](const char* key, double frequency) {
    if (frequency > most) {
      warnings.push_back(
          fmt::format("{} is {:g} Hz; above {:g} Hz, a tenth of what experiment.rate of {:g} Hz "
                      "carries, it comes in steps",
                      key, frequency, most, d.rate));
    }
  };
  warn("force_pattern.max_frequency", d.force_pattern.max_frequency);
  if (d.force_pattern.bumps_max > 0) {
    warn("the frequency of a bump of force_pattern.bump_width_min",
         1.0 / d.force_pattern.bump_width_min);
  }
  if (d.trajectory.from.empty()) {
    warn("trajectory.max_spatial_frequency times trajectory.speed",
         d.trajectory.max_spatial_frequency * d.trajectory.speed);
  }
  if (d.force_pattern.max_frequency > 0.5 * d.stimulus_rate) {
    warnings.push_back(fmt::format(
        "recording.stimulus_rate is {:g} Hz; a force pattern of up to {:g} Hz needs "
        "more than {:g} Hz to be stored as it is",
        d.stimulus_rate, d.force_pattern.max_frequency, 2.0 * d.force_pattern.max_frequency));
  }
}

void warn_of_settling(const ForceDefinition& d, Warnings& warnings) {
  const double quantum = d.device.position_quantum;
  if (d.guidance.settle_distance < quantum) {
    warnings.push_back(
        fmt::format("guidance.settle_distance is {:g} m, less than device.position_quantum, {:g} "
                    "m; readings may never come so near, and passes then end after "
                    "guidance.wait_timeout, {:g} s",
                    d.guidance.settle_distance, quantum, d.guidance.wait_timeout));
    return;
  }
  const double stiffness = std::min(d.guidance.trajectory.stiffness, d.guidance.plane.stiffness);
  if (stiffness > 0.0 && d.guidance.settle_distance < d.hand.coulomb_friction / stiffness) {
    warnings.push_back(fmt::format(
        "guidance.settle_distance is {:g} m; friction of {:g} N holds the handle {:.3g} "
        "m away against {:g} N/m, and passes then end after guidance.wait_timeout, {:g} "
        "s",
        d.guidance.settle_distance, d.hand.coulomb_friction, d.hand.coulomb_friction / stiffness,
        stiffness, d.guidance.wait_timeout));
  }
}

/// Warns of durations too short for a way from one side of the workspace to the other, at the peak
/// of a minimum-jerk move.
void warn_of_durations(const ForceDefinition& d, double length, Warnings& warnings) {
  const double run = length / d.trajectory.speed;
  const double farthest = 2.0 * d.envelope.workspace_radius;
  const double approach = 15.0 / 8.0 * farthest / d.guidance.approach_speed;
  if (approach > run) {
    warnings.push_back(
        fmt::format("guidance.approach_speed is {:g} m/s; from the far side of the workspace the "
                    "approach takes {:.0f} s, longer than the shortest run, {:.1f} s",
                    d.guidance.approach_speed, approach, run));
  }
  if (d.guidance.kind == protocols::Guidance::kCurve && d.guidance.run_timeout < run) {
    warnings.push_back(
        fmt::format("guidance.run_timeout is {:g} s; at trajectory.speed the path takes {:.1f} s "
                    "or more, so that passes end before it does",
                    d.guidance.run_timeout, run));
  }
}

/// Length of the path, at least, and how far it goes from the middle [m].
std::pair<double, double> extent_of(const ForceDefinition& d) {
  if (d.trajectory.from.empty()) {
    return {d.trajectory.length_x, 0.5 * std::hypot(d.trajectory.length_x, d.trajectory.range_z)};
  }
  double length = 0.0;
  double reach = 0.0;
  for (std::size_t k = 0; k < d.trajectory.points.size(); ++k) {
    const Eigen::Vector3d& point = d.trajectory.points[k];
    length += k > 0 ? (point - d.trajectory.points[k - 1]).norm() : 0.0;
    reach = std::max(reach, point.norm());
  }
  return {length, reach};
}

/// The order of conditions is balanced over as many participants as a Williams design has rows.
void warn_of_order(const protocols::Design& design, Warnings& warnings) {
  const auto conditions = static_cast<int>(design.conditions.size());
  const auto rows = static_cast<int>(protocols::williams_rows(conditions).size());
  if (conditions > 1 && design.participants % rows != 0) {
    warnings.push_back(fmt::format(
        "design.participants is {}; the order of {} conditions is balanced only over multiples of "
        "{} participants, so an effect of practice can look like one of a condition",
        design.participants, conditions, rows));
  }
}

}  // namespace

std::vector<std::string> ForceDefinition::warnings() const {
  const ForceDefinition& d = *this;
  const auto [length, reach] = extent_of(d);
  Warnings warnings;
  warn_of_loop(d, warnings);
  warn_of_limit(d, "guidance.force_limit", d.guidance.force_limit, warnings);
  warn_of_devices(d, reach, warnings);
  warn_of_frequencies(d, warnings);
  warn_of_settling(d, warnings);
  warn_of_durations(d, length, warnings);
  warn_of_order(d.design, warnings);
  return warnings;
}

}  // namespace haptrial::protocols
