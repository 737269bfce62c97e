#include "protocols/psychophysics/presentation/cursor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::protocols {

Cursor::Cursor(const CursorParameters& parameters, const ScreenPlane& screen, double rate,
               std::uint64_t seed)
    : parameters_(parameters),
      screen_(screen),
      past_(static_cast<std::size_t>(std::lround(parameters.delay * rate))),
      random_(seed, "cursor"),
      noise_{subject::SmoothNoise(1.0 / rate, parameters.noise_time),
             subject::SmoothNoise(1.0 / rate, parameters.noise_time)} {
  for (subject::SmoothNoise& each : noise_) {
    each.restart(random_);
  }
}

/// Before there is a past the tool is taken to have rested.
Eigen::Vector3d Cursor::delayed(const Eigen::Vector3d& tool) noexcept {
  if (past_.empty()) {
    return tool;
  }
  if (!began_) {
    std::ranges::fill(past_, tool);
    began_ = true;
  }
  const Eigen::Vector3d then = std::exchange(past_[next_], tool);
  next_ = (next_ + 1) % past_.size();
  return then;
}

Eigen::Vector3d Cursor::follow(const Eigen::Vector3d& tool) noexcept {
  const CursorParameters& p = parameters_;
  const Eigen::Vector3d way = delayed(tool) - p.about;
  const double length = p.gain * screen_.length_of(way);
  const double angle = p.clamped == 1.0 ? p.direction : screen_.angle_of(way) + p.rotation;
  Eigen::Vector3d place = p.about + screen_.along(angle, length, screen_.across(way));
  if (p.noise > 0.0) {
    const double right = p.noise * noise_[0].next(random_), up = p.noise * noise_[1].next(random_);
    place += screen_.along(0.0, right, 0.0) + screen_.along(0.5 * M_PI, up, 0.0);
  }
  return place;
}

}  // namespace haptrial::protocols
