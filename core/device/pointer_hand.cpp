#include "core/device/pointer_hand.h"

#include <algorithm>
#include <cmath>

#include "core/device/device.h"

namespace haptrial::device {
namespace {

// Codes of the window's keys: letters are their capitals.
constexpr int kRight = 262;
constexpr int kLeft = 263;
constexpr int kDown = 264;
constexpr int kUp = 265;

constexpr double kNearest = 0.01;     // of the tip to the eye [m]
constexpr double kLongest = 0.1;      // a picture that took longer moves nothing further [s]
constexpr double kComesBack = 150.0;  // way of the pointer on which the tip comes back to it [px]

double sign_of(std::span<const int> keys, int plus, int minus) {
  const auto held = [&](int key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
  return (held(plus) ? 1.0 : 0.0) - (held(minus) ? 1.0 : 0.0);
}

}  // namespace

/// Map from points of W to a picture.
struct PointerHand::Screen {
  Screen(const Camera& camera, int width, int height)
      : eye(camera.eye),
        axes(camera.axes()),
        slope(2.0 * std::tan(0.5 * camera.field_of_view) / height),
        middle(0.5 * width, 0.5 * height) {}

  double depth(const Eigen::Vector3d& point) const { return axes.col(2).dot(eye - point); }
  Eigen::Vector2d pixel(const Eigen::Vector3d& point) const {
    const double unit = std::max(kNearest, depth(point)) * slope;
    const Eigen::Vector3d way = point - eye;
    return middle + Eigen::Vector2d(axes.col(0).dot(way), -axes.col(1).dot(way)) / unit;
  }
  Eigen::Vector3d point(const Eigen::Vector2d& pixel, double depth) const {
    const Eigen::Vector2d way = slope * (pixel - middle);
    return eye + depth * (way.x() * axes.col(0) - way.y() * axes.col(1) - axes.col(2));
  }

  Eigen::Vector3d eye;
  Eigen::Matrix3d axes;
  double slope;  // per pixel
  Eigen::Vector2d middle;
};

HandPose PointerHand::follow(const Camera& camera, int width, int height, const PointerInput& input,
                             const Eigen::Vector3d& tip, bool view_held) {
  const Screen screen(camera, width, height);
  const bool first = !camera_;
  if (first) {
    pose_.position = p_.start;
    pixel_ = input.pixel;
    wheel_ = input.wheel;
  }
  const Eigen::Vector2d dragged = input.pixel - pixel_;
  if (!first && !(*camera_ == camera)) {
    offset_ = screen.pixel(pose_.position) - pixel_;
  }
  if (is_pressed(input.buttons, p_.turn_button)) {
    offset_ -= dragged;
    turn(screen, input, dragged);
  } else {
    offset_ *= view_held ? 1.0 : std::exp(-dragged.norm() / kComesBack);
    turn(screen, input, Eigen::Vector2d::Zero());
  }
  const double keyed =
      p_.depth_speed * std::min(input.dt, kLongest) * sign_of(input.keys, 'W', 'S');
  const double wanted =
      screen.depth(pose_.position) + keyed + p_.wheel_step * (input.wheel - wheel_);
  const double most = first ? wanted : screen.depth(tip) + p_.leash;
  pose_.position = screen.point(input.pixel + offset_, std::max(kNearest, std::min(wanted, most)));
  const double length = pose_.position.norm();
  pose_.position *= length > p_.reach ? p_.reach / length : 1.0;
  camera_ = camera;
  pixel_ = input.pixel;
  wheel_ = input.wheel;
  return pose_;
}

void PointerHand::turn(const Screen& screen, const PointerInput& input,
                       const Eigen::Vector2d& dragged) {
  const double keyed = p_.turn_speed * std::min(input.dt, kLongest);
  const Eigen::Vector3d turned =
      (keyed * (sign_of(input.keys, kDown, kUp) + input.turn.x()) +
       p_.turn_per_pixel * dragged.y()) *
          screen.axes.col(0) +
      (keyed * (sign_of(input.keys, kRight, kLeft) + input.turn.y()) +
       p_.turn_per_pixel * dragged.x()) *
          screen.axes.col(1) +
      keyed * (sign_of(input.keys, 'Q', 'E') + input.turn.z()) * screen.axes.col(2);
  const double angle = turned.norm();
  if (angle > 0.0) {
    const Eigen::AngleAxisd by(angle, turned / angle);
    pose_.orientation = (Eigen::Quaterniond(by) * pose_.orientation).normalized();
  }
}

}  // namespace haptrial::device
