#include "core/deformable/touch/touch_cost.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kPlaces = 12;  // that are pressed
constexpr int kTicks = 100;          // at each
constexpr double kDeep = 0.4;        // of the ball's radius
constexpr double kAlong = 0.1;       // of it: how far the ball wanders to the side

double seconds_of_tick(BallTouch& touch, const Vector3d& tool) {
  const auto begin = std::chrono::steady_clock::now();
  touch.tick(tool, 0.001);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// In and out again over one face.
void press(BallTouch& touch, const Compliance& body, std::size_t face, double radius,
           std::vector<double>& times) {
  std::array<Vector3d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = body.rest(body.faces()[face][k]);
  }
  const Vector3d outward = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
  const Vector3d along = (p[1] - p[0]).stableNormalized();
  const Vector3d middle = (p[0] + p[1] + p[2]) / 3.0;
  touch.start(middle + 2.0 * radius * outward);
  for (int tick = 0; tick < kTicks; ++tick) {
    const double share = static_cast<double>(tick) / kTicks;
    const double depth = kDeep * radius * (1.0 - std::abs(2.0 * share - 1.0));
    const Vector3d tool = middle + (radius - depth) * outward + kAlong * radius * share * along;
    times.push_back(seconds_of_tick(touch, tool));
  }
}

}  // namespace

TouchCost measured_cost(const SharedCompliance& body, const TouchOptions& options) {
  BallTouch touch(body, options);
  const double radius = std::max(options.radius, smallest_ball(body->mesh()));
  const std::size_t places = std::min(kPlaces, body->faces().size());
  std::vector<double> times;
  for (std::size_t i = 0; i < places; ++i) {
    press(touch, *body, i * body->faces().size() / places, radius, times);
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  return {at(0.5), at(0.99), touch.counts().crowded > 0};
}

}  // namespace haptrial::deformable
