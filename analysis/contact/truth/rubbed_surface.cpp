#include "analysis/contact/truth/rubbed_surface.h"

#include <algorithm>

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr double kSkin = 1e-14;        // heights are rounded to less [m]
constexpr double kStill = 1e-13;       // a pull along the surface below this is none [m]
constexpr double kFlowTime = 0.1;      // in which the pull along a plane falls by a tenth
constexpr int kMostFlows = 1000;       // it falls below any length in far fewer
constexpr double kShortFlight = 1e-4;  // of a flight: a dip that is shorter may be missed
constexpr int kHalvings = 60;          // of an interval, to its last digit
constexpr int kMostFlights = 16;       // a tick

/// The least of [low, high] for which `there` holds, if it holds at `high` and not at `low`.
template <class There>
double first_of(double low, double high, const There& there) {
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (there(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

RubbedSurface::RubbedSurface(std::unique_ptr<SmoothSurface> surface, double friction)
    : surface_(std::move(surface)), friction_(friction) {}

RubbedSurface::Hold RubbedSurface::hold(const Vector3d& at, const Vector3d& tool) const {
  const Vector3d n = surface_->normal(at), force = at - tool;
  const double push = force.dot(n);
  if (!(push > 0.0)) {
    return Hold::kLeaves;
  }
  return (force - push * n).norm() <= friction_ * push + kStill ? Hold::kHeld : Hold::kSlides;
}

/// @returns false if the proxy leaves the surface
bool RubbedSurface::slide(Vector3d& at, const Vector3d& tool) const {
  Hold now = hold(at, tool);
  if (const auto rest = now == Hold::kSlides ? surface_->cone(at, tool, friction_) : std::nullopt) {
    at = *rest;
    return true;
  }
  for (int i = 0; i < kMostFlows && now == Hold::kSlides; ++i) {
    Vector3d there = surface_->flow(at, tool, kFlowTime);
    now = hold(there, tool);
    if (now != Hold::kSlides) {
      const double time = first_of(0.0, kFlowTime, [&](double t) {
        return hold(surface_->flow(at, tool, t), tool) != Hold::kSlides;
      });
      there = surface_->flow(at, tool, time);
      now = hold(there, tool);
    }
    at = there;
  }
  return now != Hold::kLeaves;
}

/// First point at which a straight way enters the solid.
std::optional<Vector3d> RubbedSurface::meet(const Vector3d& from, const Vector3d& to) const {
  const Vector3d way = to - from;
  const double length = std::max(way.norm(), kSkin);
  const auto inside = [&](double t) { return surface_->height(from + t * way) < -kSkin; };
  for (double t = 0.0; t < 1.0;) {
    const double next =
        std::min(1.0, t + std::max(surface_->height(from + t * way) / length, kShortFlight));
    if (inside(next)) {
      return surface_->onto(from + first_of(t, next, inside) * way);
    }
    t = next;
  }
  return std::nullopt;
}

std::optional<Vector3d> RubbedSurface::next(const Vector3d& tool) {
  if (!place_) {
    place_ = tool;
    return surface_->height(tool) < 0.0 ? place_ : std::nullopt;
  }
  for (int flight = 0; flight < kMostFlights; ++flight) {
    if (!touching_) {
      const auto met = meet(*place_, tool);
      place_ = met.value_or(tool);
      touching_ = met.has_value();
    }
    if (touching_) {
      touching_ = slide(*place_, tool);
    }
    if (touching_) {
      return place_;
    }
    if (*place_ == tool) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace haptrial::evaluation
