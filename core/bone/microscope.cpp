#include "core/bone/microscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/table.h"

namespace haptrial::bone {
namespace {

constexpr double kPole = 0.02;  // how close the view comes to `up` [rad]

Eigen::Vector3d read_vector(Table& table, const char* key, const char* unit) {
  const std::vector<double> numbers = table.numbers(key, {-10.0, 10.0}, unit);
  if (numbers.size() != 3) {
    table.reject(key, fmt::format("a list of {} numbers", numbers.size()),
                 "three numbers: x, y, z");
    return Eigen::Vector3d::Zero();
  }
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

Eigen::Matrix3d Microscope::axes() const noexcept {
  Eigen::Matrix3d axes;
  axes.col(2) = (eye - target).normalized();
  axes.col(0) = up.cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

MicroscopeParameters read_microscope_parameters(Table& table) {
  MicroscopeParameters p;
  p.start.eye = read_vector(table, "eye", "m");
  p.start.target = read_vector(table, "target", "m");
  p.start.up = read_vector(table, "up", "");
  const auto optional = [&](const char* key, double& value, const Bounds& bounds,
                            const char* unit) {
    value = table.has(key) ? table.number(key, bounds, unit) : value;
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

Microscope moved(const Microscope& from, const Eigen::Vector3d& motion) noexcept {
  Microscope to = from;
  const Eigen::Vector3d way = from.axes() * motion;
  to.eye += way;
  to.target += way;
  return to;
}

Microscope turned(const Microscope& from, double right, double above) noexcept {
  const Eigen::Vector3d pole = from.up.normalized();
  const Eigen::Vector3d arm = from.eye - from.target;
  const double length = arm.norm();
  const double now = std::acos(std::clamp(arm.dot(pole) / length, -1.0, 1.0));  // from the pole
  const double then = std::clamp(now - above, kPole, std::numbers::pi - kPole);
  const Eigen::Vector3d side = from.axes().col(0);
  Microscope to = from;
  // Down from the pole about the picture's right, then around the pole.
  to.eye =
      from.target + Eigen::AngleAxisd(right, pole) * (Eigen::AngleAxisd(then - now, side) * arm);
  return to;
}

Microscope zoomed(const Microscope& from, double factor,
                  const MicroscopeParameters& bounds) noexcept {
  Microscope to = from;
  const double half = std::atan(std::tan(0.5 * from.field_of_view) / factor);
  to.field_of_view = std::clamp(2.0 * half, bounds.narrowest, bounds.widest);
  return to;
}

}  // namespace haptrial::bone
