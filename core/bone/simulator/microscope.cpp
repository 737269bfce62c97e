#include "core/bone/simulator/microscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/definition/table_vector.h"

namespace haptrial::bone {
namespace {

constexpr double kPole = 0.02;  // how close the view comes to `up` [rad]
constexpr Bounds kReach{-10.0, 10.0};

}  // namespace

MicroscopeParameters read_microscope_parameters(Table& table) {
  MicroscopeParameters p;
  p.start.eye = read_vector(table, "eye", kReach, "m");
  p.start.target = read_vector(table, "target", kReach, "m");
  p.start.up = read_vector(table, "up", kReach, "");
  const auto optional = [&](const char* key, double& value, const Bounds& bounds,
                            const char* unit) {
    value = table.number_or(key, value, bounds, unit);
  };
  optional("narrowest", p.narrowest, {0.001, 3.0}, "rad");
  optional("widest", p.widest, {0.001, 3.0}, "rad");
  optional("move_gain", p.move_gain, {0.0, 100.0}, "");
  optional("turn_gain", p.turn_gain, {0.0, 1000.0}, "rad/m");
  optional("zoom_rate", p.zoom_rate, {0.0, 100.0}, "1/s");
  p.start.field_of_view = table.number("field_of_view", {0.001, 3.0}, "rad");
  if (p.start.eye == p.start.target) {
    table.reject("eye", "is the same point as target; choose another point");
  } else if (!(p.start.up.cross(p.start.eye - p.start.target).norm() >
               1e-6 * p.start.up.norm() * (p.start.eye - p.start.target).norm())) {
    table.reject("up", "is zero or along the view; write a direction across the view");
  }
  if (p.narrowest > p.widest || p.start.field_of_view < p.narrowest ||
      p.start.field_of_view > p.widest) {
    table.reject("field_of_view", fmt::format("{}", p.start.field_of_view),
                 fmt::format("from narrowest, {}, to widest, {} [rad]", p.narrowest, p.widest));
  }
  return p;
}

Camera moved(const Camera& from, const Eigen::Vector3d& motion) noexcept {
  Camera to = from;
  const Eigen::Vector3d way = from.axes() * motion;
  to.eye += way;
  to.target += way;
  return to;
}

Camera turned(const Camera& from, double right, double above) noexcept {
  const Eigen::Vector3d pole = from.up.normalized();
  const Eigen::Vector3d arm = from.eye - from.target;
  const double length = arm.norm();
  const double now = std::acos(std::clamp(arm.dot(pole) / length, -1.0, 1.0));  // from the pole
  const double then = std::clamp(now - above, kPole, std::numbers::pi - kPole);
  const Eigen::Vector3d side = from.axes().col(0);
  Camera to = from;
  // Down from the pole about the picture's right, then around the pole.
  to.eye =
      from.target + Eigen::AngleAxisd(right, pole) * (Eigen::AngleAxisd(then - now, side) * arm);
  return to;
}

Camera zoomed(const Camera& from, double factor, const MicroscopeParameters& bounds) noexcept {
  Camera to = from;
  const double half = std::atan(std::tan(0.5 * from.field_of_view) / factor);
  to.field_of_view = std::clamp(2.0 * half, bounds.narrowest, bounds.widest);
  return to;
}

}  // namespace haptrial::bone
