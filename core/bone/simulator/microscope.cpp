#include "core/bone/simulator/microscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/definition/schema.h"

namespace haptrial::bone {
namespace {

constexpr double kPole = 0.02;  // how close the view comes to `up` [rad]
constexpr Bounds kReach{-10.0, 10.0};

const Schema<Camera>& view_schema() {
  static const auto schema =
      Schema<Camera>()
          .vector("eye", &Camera::eye, kReach, "m", "Place of the microscope at the start")
          .required()
          .vector("target", &Camera::target, kReach, "m",
                  "Point that the microscope looks at, at the start")
          .required()
          .vector("up", &Camera::up, kReach, "",
                  "Direction in the world that is upward in the picture")
          .required()
          .number("field_of_view", &Camera::field_of_view, {0.001, 3.0}, "rad",
                  "Field of view of the microscope at the start, from the bottom to the top of the "
                  "picture")
          .required()
          .check([](Table& table, Camera& view) {
            const Eigen::Vector3d way = view.eye - view.target;
            if (view.eye == view.target) {
              table.reject("eye", "is the same point as target; choose another point");
            } else if (!(view.up.cross(way).norm() > 1e-6 * view.up.norm() * way.norm())) {
              table.reject("up", "is zero or along the view; write a direction across the view");
            }
          });
  return schema;
}

}  // namespace

const Schema<MicroscopeParameters>& microscope_schema() {
  using P = MicroscopeParameters;
  static const auto schema =
      Schema<P>()
          .keys_of(&P::start, view_schema())
          .number("narrowest", &P::narrowest, {0.001, 3.0}, "rad",
                  "Smallest field of view to which the microscope zooms in")
          .number("widest", &P::widest, {0.001, 3.0}, "rad",
                  "Largest field of view to which the microscope zooms out")
          .number("move_gain", &P::move_gain, {0.0, 100.0}, "",
                  "Distance that the view moves for a distance of the hand")
          .number("turn_gain", &P::turn_gain, {0.0, 1000.0}, "rad/m",
                  "Angle by which the view turns for a distance of the hand")
          .number("zoom_rate", &P::zoom_rate, {0.0, 100.0}, "1/s",
                  "Speed at which a held button zooms, in factors of e a second")
          .check([](Table& table, P& p) {
            const double view = p.start.field_of_view;
            if (p.narrowest > p.widest || view < p.narrowest || view > p.widest) {
              table.reject(
                  "field_of_view", fmt::format("{}", view),
                  fmt::format("from narrowest, {}, to widest, {} [rad]", p.narrowest, p.widest));
            }
          });
  return schema;
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
