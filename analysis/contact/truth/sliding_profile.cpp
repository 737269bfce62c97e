#include "analysis/contact/truth/sliding_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::evaluation {
namespace {

using Eigen::Vector2d;

constexpr double kLongest = 1e3;  // of the sides of an endless wedge [m]

double turn_of(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

ConvexProfile::ConvexProfile(std::vector<Vector2d> corners, bool closed)
    : corners_(std::move(corners)), closed_(closed) {}

Vector2d ConvexProfile::along(std::size_t side) const {
  return (corner(side + 1) - corner(side)).normalized();
}

/// The side through which the straight way from the last place in the air enters.
void ConvexProfile::enter(const Vector2d& tool) {
  double latest = -1.0;
  for (std::size_t s = 0; s < sides(); ++s) {
    const double before = turn_of(along(s), *last_ - corner(s));
    const double now = turn_of(along(s), tool - corner(s));
    if (before <= 0.0 && now > 0.0) {
      const double t = before / (before - now);
      if (t >= latest) {  // inside of a convex polygon from the last line that is crossed
        latest = t;
        side_ = s;
      }
    }
  }
}

/// Down the distance to the tool, along the sides.
Vector2d ConvexProfile::slide(const Vector2d& tool) {
  for (std::size_t turns = 0; turns <= 2 * corners_.size(); ++turns) {
    const Vector2d direction = along(*side_);
    const double length = (corner(*side_ + 1) - corner(*side_)).norm();
    const double t = (tool - corner(*side_)).dot(direction);
    const bool forward = t > length && (closed_ || *side_ + 1 < sides());
    const bool backward = t < 0.0 && (closed_ || *side_ > 0);
    const std::size_t next = (*side_ + (forward ? 1 : sides() - 1)) % sides();
    const Vector2d end = corner(forward ? *side_ + 1 : *side_);
    const double gain = (tool - end).dot(along(next)) * (forward ? 1.0 : -1.0);
    if ((!forward && !backward) || gain <= 0.0) {
      return corner(*side_) + std::clamp(t, 0.0, length) * direction;
    }
    side_ = next;
  }
  return corner(*side_);
}

std::optional<Vector2d> ConvexProfile::next(const Vector2d& tool) {
  if (!side_) {
    bool inside = true;
    for (std::size_t s = 0; s < sides(); ++s) {
      inside = inside && turn_of(along(s), tool - corner(s)) > 0.0;
    }
    if (inside && last_) {
      enter(tool);
    } else if (inside) {
      side_ = 0;
    }
  }
  if (side_) {
    const Vector2d proxy = slide(tool);
    if (turn_of(along(*side_), tool - corner(*side_)) > 0.0) {
      return proxy;
    }
    side_.reset();
  }
  last_ = tool;
  return std::nullopt;
}

ConvexProfile wedge_profile(double flank) {
  const Vector2d down(kLongest * std::cos(flank), -kLongest * std::sin(flank));
  return ConvexProfile({down, Vector2d::Zero(), Vector2d(-down.x(), down.y())}, false);
}

ConvexProfile plate_profile(double width, double thickness) {
  const double x = 0.5 * width, y = 0.5 * thickness;
  return ConvexProfile({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, true);
}

WavyProfile::WavyProfile(double height, double length)
    : height_(height), wave_number_(2.0 * std::numbers::pi / length) {}

double WavyProfile::height(double x) const { return height_ * std::sin(wave_number_ * x); }

double WavyProfile::steepness(double x) const {
  return height_ * wave_number_ * std::cos(wave_number_ * x);
}

/// The nearest bottom of the distance downhill from `x`: where half its square has no slope.
double WavyProfile::slide(double x, const Vector2d& tool) const {
  const auto slope = [&](double at) {
    return at - tool.x() + (height(at) - tool.y()) * steepness(at);
  };
  const double step = 1e-4 / wave_number_;
  const double way = slope(x) < 0.0 ? 1.0 : -1.0;
  double near = x, far = x;
  while (way * slope(far) < 0.0) {
    near = far;
    far += way * step;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    (way * slope(middle) < 0.0 ? near : far) = middle;
  }
  return 0.5 * (near + far);
}

std::optional<Vector2d> WavyProfile::next(const Vector2d& tool) {
  if (!x_ && !(tool.y() < height(tool.x()))) {
    return std::nullopt;
  }
  x_ = slide(x_.value_or(tool.x()), tool);  // steps are small: the way in is near
  const Vector2d proxy(*x_, height(*x_));
  if (Vector2d(-steepness(*x_), 1.0).dot(tool - proxy) >= 0.0) {
    x_.reset();
    return std::nullopt;
  }
  return proxy;
}

}  // namespace haptrial::evaluation
