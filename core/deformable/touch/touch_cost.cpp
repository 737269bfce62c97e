#include "core/deformable/touch/touch_cost.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kPlaces = 12;  // that are pressed
constexpr std::size_t kTicks = 100;  // at each
constexpr int kAgain = 3;            // times; each tick's least counts
constexpr double kLong = 0.1;        // one time is enough then [s]
constexpr double kDeep = 0.4;        // of the ball's radius
constexpr double kAlong = 0.1;       // of it: how far the ball wanders to the side

double seconds_of_tick(BodyTouch& touch, const Vector3d& tool, double period) {
  const auto begin = std::chrono::steady_clock::now();
  touch.tick(tool, period);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Presses in and out again over one face. @param times  (kTicks) of each tick the least so far [s]
/// @returns how long all of it took [s]
double press(BodyTouch& touch, const HapticMesh& mesh, std::size_t face, double radius,
             double period, std::span<double> times) {
  std::array<Vector3d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = mesh.tets.vertices[static_cast<std::size_t>(mesh.felt[face][k])];
  }
  const Vector3d outward = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
  const Vector3d along = (p[1] - p[0]).stableNormalized();
  const Vector3d middle = (p[0] + p[1] + p[2]) / 3.0;
  touch.start(middle + 2.0 * radius * outward);
  double sum = 0.0;
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    const double share = static_cast<double>(tick) / kTicks;
    const double depth = kDeep * radius * (1.0 - std::abs(2.0 * share - 1.0));
    const Vector3d tool = middle + (radius - depth) * outward + kAlong * radius * share * along;
    const double taken = seconds_of_tick(touch, tool, period);
    times[tick] = std::min(times[tick], taken);
    sum += taken;
  }
  return sum;
}

}  // namespace

TouchCost measured_cost(BodyTouch& touch, const HapticMesh& mesh, double radius, double period) {
  const double felt = std::max(radius, smallest_ball(mesh));
  const std::size_t places = std::min(kPlaces, mesh.felt.size());
  std::vector<double> times(places * kTicks, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < places; ++i) {
    const auto own = std::span(times).subspan(i * kTicks, kTicks);
    const std::size_t face = i * mesh.felt.size() / places;
    // The same ticks again, as other work on the machine slows some of them.
    for (int again = 0; again < kAgain; ++again) {
      if (press(touch, mesh, face, felt, period, own) > kLong) {
        break;
      }
    }
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  return {at(0.5), at(0.99), touch.counts().crowded > 0};
}

TouchCost measured_cost(const SharedCompliance& body, const TouchOptions& options) {
  constexpr double kAnyPeriod = 0.001;  // at rest on every tick [s]
  BallTouch touch(body, options);
  return measured_cost(touch, body->mesh(), options.radius, kAnyPeriod);
}

}  // namespace haptrial::deformable
