#include "analysis/reaching/reach_metrics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace haptrial::analysis {
namespace {

void check_movement(const MovementOptions& o) {
  if (!(o.onset_speed > 0.0)) {
    throw std::invalid_argument("onset_speed must be above 0");
  }
  if (!(o.search_from >= 0.0 && o.search_from < 1.0)) {
    throw std::invalid_argument("search_from must be at least 0 and below 1");
  }
  if (!(o.end_speed > 0.0)) {
    throw std::invalid_argument("end_speed must be above 0");
  }
  if (!(o.end_hold >= 0.0)) {
    throw std::invalid_argument("end_hold must not be negative");
  }
}

/// Time at which the speed passes a level between samples i - 1 and i.
double crossing(std::span<const double> time, const std::vector<double>& speed, std::size_t i,
                double level) {
  const double part = (level - speed[i - 1]) / (speed[i] - speed[i - 1]);
  return time[i - 1] + std::clamp(part, 0.0, 1.0) * (time[i] - time[i - 1]);
}

std::optional<double> end_after(std::span<const double> time, const std::vector<double>& speed,
                                std::size_t peak, const MovementOptions& options) {
  std::optional<std::size_t> slow;
  for (std::size_t i = peak + 1; i < speed.size(); ++i) {
    if (!(speed[i] < options.end_speed)) {
      slow.reset();
      continue;
    }
    slow = slow.value_or(i);
    if (time[i] - time[*slow] >= options.end_hold) {
      break;
    }
  }
  if (!slow) {
    return std::nullopt;
  }
  return crossing(time, speed, *slow, options.end_speed);
}

}  // namespace

Movement find_movement(std::span<const double> time, std::span<const Eigen::Vector3d> velocity,
                       double go, const MovementOptions& options) {
  check_movement(options);
  std::vector<double> speed(velocity.size());
  std::ranges::transform(velocity, speed.begin(), [](const auto& v) { return v.norm(); });
  const auto after_go = std::ranges::lower_bound(time, go) - time.begin();
  Movement movement;
  if (after_go == std::ssize(speed)) {
    return movement;
  }
  const auto fastest = std::max_element(speed.begin() + after_go, speed.end());
  movement.peak_speed = *fastest;
  const double from = std::max(options.onset_speed, options.search_from * *fastest);
  const auto fast =
      std::find_if(speed.begin() + after_go, speed.end(), [from](double s) { return s > from; });
  if (fast == speed.end()) {
    return movement;
  }
  auto first = static_cast<std::size_t>(fast - speed.begin());
  while (first > 0 && speed[first - 1] > options.onset_speed) {
    --first;
  }
  if (first == 0) {
    movement.moving_at_start = true;
    return movement;
  }
  const auto peak = static_cast<std::size_t>(fastest - speed.begin());
  movement.onset = crossing(time, speed, first, options.onset_speed);
  movement.peak_time = time[peak];
  movement.end = end_after(time, speed, peak, options);
  return movement;
}

namespace {

void check_metric_options(const MetricOptions& o) {
  if (!(o.target_radius > 0.0)) {
    throw std::invalid_argument("target_radius must be above 0");
  }
  if (!(o.direction_after > 0.0)) {
    throw std::invalid_argument("direction_after must be above 0");
  }
}

bool is_finite(const Reach& reach) {
  const auto finite = [](const Eigen::Vector3d& v) { return v.allFinite(); };
  return std::ranges::all_of(reach.position, finite) &&
         std::ranges::all_of(reach.velocity, finite) && std::ranges::all_of(reach.force, finite);
}

/// Samples from onset to end, with both ends interpolated.
struct Cut {
  std::vector<double> time;
  std::vector<Eigen::Vector3d> values;
};

Cut cut_out(std::span<const double> time, std::span<const Eigen::Vector3d> values, double from,
            double to) {
  Cut cut{{from}, {*value_at(time, values, from)}};
  for (auto i = static_cast<std::size_t>(std::ranges::upper_bound(time, from) - time.begin());
       i < time.size() && time[i] < to; ++i) {
    cut.time.push_back(time[i]);
    cut.values.push_back(values[i]);
  }
  cut.time.push_back(to);
  cut.values.push_back(*value_at(time, values, to));
  return cut;
}

double larger(double a, double b) { return std::abs(b) > std::abs(a) ? b : a; }

void measure_path(const Cut& path, const WayFrame& frame, const Eigen::Vector3d& start,
                  ReachMetrics& metrics) {
  double length = 0.0, area = 0.0;
  double farthest = frame.lateral(path.values.front() - start);
  for (std::size_t i = 1; i < path.values.size(); ++i) {
    const Eigen::Vector3d step = path.values[i] - path.values[i - 1];
    const double before = frame.lateral(path.values[i - 1] - start);
    const double here = frame.lateral(path.values[i] - start);
    length += step.norm();
    area += 0.5 * (before + here) * frame.along(step);
    farthest = larger(farthest, here);
  }
  metrics.path_length = length;
  metrics.signed_area = area;
  metrics.maximum_perpendicular_error = farthest;
}

void measure_force(const Cut& force, const WayFrame& frame, ReachMetrics& metrics) {
  double impulse = 0.0;
  double peak = frame.lateral(force.values.front());
  for (std::size_t i = 1; i < force.values.size(); ++i) {
    const double here = frame.lateral(force.values[i]);
    const double before = frame.lateral(force.values[i - 1]);
    impulse += 0.5 * (before + here) * (force.time[i] - force.time[i - 1]);
    peak = larger(peak, here);
  }
  const double duration = force.time.back() - force.time.front();
  if (duration > 0.0) {
    metrics.mean_lateral_force = impulse / duration;
  }
  metrics.peak_lateral_force = peak;
}

void measure_end(const Reach& reach, const WayFrame& frame, double radius, ReachMetrics& metrics) {
  const Eigen::Vector3d miss = *value_at(reach.time, reach.position, *metrics.end) - reach.target;
  metrics.movement_time = *metrics.end - *metrics.onset;
  metrics.endpoint_error = miss.norm();
  metrics.endpoint_extent = frame.along(miss);
  metrics.flags.missed_target = miss.norm() > radius;
}

void measure_direction(const Reach& reach, const WayFrame& frame, double after,
                       ReachMetrics& metrics) {
  const auto then = value_at(reach.time, reach.position, *metrics.onset + after);
  if (!then) {
    return;
  }
  const Eigen::Vector3d moved = *then - *value_at(reach.time, reach.position, *metrics.onset);
  if (frame.along(moved) != 0.0 || frame.lateral(moved) != 0.0) {
    metrics.direction_error = frame.angle(moved);
  }
}

}  // namespace

ReachMetrics reach_metrics(const Reach& reach, const MetricOptions& options) {
  check_reach(reach);
  check_metric_options(options);
  const WayFrame frame(reach.start, reach.target, options.normal);
  ReachMetrics metrics;
  metrics.flags.not_finite = !is_finite(reach);
  if (metrics.flags.not_finite) {
    return metrics;
  }
  const Movement movement = find_movement(reach.time, reach.velocity, reach.go, options.movement);
  metrics.flags.moving_at_start = movement.moving_at_start;
  metrics.flags.no_onset = !movement.onset && !movement.moving_at_start;
  if (!movement.onset) {
    return metrics;
  }
  metrics.onset = movement.onset;
  metrics.end = movement.end;
  metrics.flags.anticipated = *metrics.onset < reach.go;
  metrics.flags.never_slowed = !metrics.end;
  metrics.reaction_time = *metrics.onset - reach.go;
  metrics.peak_speed = movement.peak_speed;
  metrics.time_to_peak = *movement.peak_time - *metrics.onset;
  const double to = metrics.end.value_or(reach.time.back());
  measure_path(cut_out(reach.time, reach.position, *metrics.onset, to), frame, reach.start,
               metrics);
  measure_direction(reach, frame, options.direction_after, metrics);
  if (metrics.end) {
    measure_end(reach, frame, options.target_radius, metrics);
  }
  if (!reach.force.empty()) {
    measure_force(cut_out(reach.time, reach.force, *metrics.onset, to), frame, metrics);
  }
  return metrics;
}

std::optional<double> perpendicular_error_at(const Reach& reach, const ReachMetrics& metrics,
                                             double after_onset, const Eigen::Vector3d& normal) {
  if (!metrics.onset) {
    return std::nullopt;
  }
  const auto position = value_at(reach.time, reach.position, *metrics.onset + after_onset);
  if (!position) {
    return std::nullopt;
  }
  return WayFrame(reach.start, reach.target, normal).lateral(*position - reach.start);
}

}  // namespace haptrial::analysis
