#include "protocols/psychophysics/definition/cursor_parameters.h"

#include <fmt/format.h>

#include <cmath>

namespace haptrial::protocols {
namespace {

constexpr Bounds kPlace{-1.0, 1.0};
constexpr Bounds kAngle{-100.0, 100.0};

}  // namespace

double ScreenPlane::angle_of(const Eigen::Vector3d& way) const noexcept {
  return std::atan2(from_above ? -way.z() : way.y(), way.x());
}

double ScreenPlane::length_of(const Eigen::Vector3d& way) const noexcept {
  return std::hypot(way.x(), from_above ? way.z() : way.y());
}

double ScreenPlane::across(const Eigen::Vector3d& way) const noexcept {
  return from_above ? way.y() : way.z();
}

Eigen::Vector3d ScreenPlane::along(double angle, double length, double across) const noexcept {
  const double right = length * std::cos(angle), up = length * std::sin(angle);
  return from_above ? Eigen::Vector3d(right, across, -up) : Eigen::Vector3d(right, up, across);
}

Eigen::Vector3d ScreenPlane::turned(const Eigen::Vector3d& way, double angle) const noexcept {
  return along(angle_of(way) + angle, length_of(way), across(way));
}

const Schema<CursorParameters>& cursor_schema() {
  using C = CursorParameters;
  static const auto schema =
      Schema<C>()
          .vector("about", &C::about, kPlace, "m",
                  "Place about which the cursor's way is scaled and turned")
          .otherwise("0, 0, 0")
          .number("gain", &C::gain, {-10.0, 10.0}, "",
                  "Way of the cursor for each metre of the tool's, from the place it is about")
          .number("rotation", &C::rotation, kAngle, "rad",
                  "Turn of the cursor's way against the tool's, counterclockwise on the screen")
          .number("clamped", &C::clamped, {0.0, 1.0}, "",
                  "1: the cursor moves in `direction` alone, whatever direction the tool takes; 0: "
                  "it moves as the tool does")
          .check([](Table& table, C& cursor) {
            if (cursor.clamped != 0.0 && cursor.clamped != 1.0) {
              table.reject("clamped", fmt::format("{:g}", cursor.clamped), "0 or 1");
            }
          })
          .number("direction", &C::direction, kAngle, "rad",
                  "Direction of a clamped cursor on the screen, counterclockwise from the right")
          .number("delay", &C::delay, {0.0, 2.0}, "s", "Time by which the cursor follows the tool")
          .number("noise", &C::noise, {0.0, 0.1}, "m",
                  "Standard deviation of the cursor's place about where it belongs")
          .number("noise_time", &C::noise_time, {0.01, 10.0}, "s",
                  "Correlation time of the noise of the cursor's place");
  return schema;
}

}  // namespace haptrial::protocols
