#include "analysis/reaching/movement.h"

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

}  // namespace haptrial::analysis
