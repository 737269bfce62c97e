#include "analysis/contact/truth/rubbed_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::evaluation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;  // of where a way meets a face: more than it, nothing felt [m]

double cross_of(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

RubbedProfile::RubbedProfile(std::vector<ProfileFace> faces, bool closed, double friction)
    : faces_(std::move(faces)), closed_(closed), friction_(friction) {}

Vector3d RubbedProfile::place(const Spot& spot) const {
  const ProfileFace& face = faces_[spot.face];
  const Vector2d on = face.start + spot.along * face.along;
  return {on.x(), on.y(), spot.z};
}

/// @returns false if the proxy leaves the surface; `left` says over what
bool RubbedProfile::slide(Spot& at, const Vector3d& tool, LeftFaces& left) const {
  left = {at.face, at.face};
  for (std::size_t turns = 0; turns <= 2 * faces_.size(); ++turns) {
    const ProfileFace& face = faces_[at.face];
    const Vector2d to = tool.head<2>() - face.start;
    const double push = -face.normal().dot(to);
    if (!(push > 0.0)) {
      return false;
    }
    const Vector2d foot(face.along.dot(to), tool.z()), here(at.along, at.z);  // on the face
    const double far = (here - foot).norm(), reach = friction_ * push;
    if (far <= reach) {
      return true;
    }
    const Vector2d goal = foot + reach / far * (here - foot);
    const bool forward = goal.x() > face.high;
    if (!forward && !(goal.x() < face.low)) {
      at = {at.face, goal.x(), goal.y()};
      return true;
    }
    const double end = forward ? face.high : face.low;
    const std::size_t other = (at.face + (forward ? 1 : faces_.size() - 1)) % faces_.size();
    const ProfileFace& next = faces_[other];
    const double begin = forward ? next.low : next.high;
    at.along = end;
    at.z += (end - here.x()) / (goal.x() - here.x()) * (goal.y() - here.y());
    const double pulled =
        (next.along.dot(tool.head<2>() - next.start) - begin) * (forward ? 1.0 : -1.0);
    const double turn = cross_of(face.along, next.along) * (forward ? 1.0 : -1.0);
    if (turn < 0.0 && pulled < 0.0) {
      rest_in_valley(at, other, tool);
      return true;
    }
    left = {at.face, other};
    at = {other, begin, at.z};
  }
  return true;
}

/// Both faces push: what each pushes with adds up to the force across the valley.
void RubbedProfile::rest_in_valley(Spot& at, std::size_t other, const Vector3d& tool) const {
  const Vector2d force = (place(at) - tool).head<2>();
  const Vector2d a = faces_[at.face].normal(), b = faces_[other].normal();
  const double pressure = (cross_of(force, b) + cross_of(a, force)) / cross_of(a, b);
  const double far = at.z - tool.z(), reach = friction_ * pressure;
  at.z = tool.z() + std::clamp(far, -reach, reach);
}

/// First point at which a straight way enters the solid, over none of the faces that it leaves.
std::optional<RubbedProfile::Spot> RubbedProfile::meet(const Vector3d& from, const Vector3d& to,
                                                       const std::optional<LeftFaces>& left) const {
  std::optional<Spot> first;
  double soonest = kEndless;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const ProfileFace& face = faces_[f];
    const double before = face.normal().dot(from.head<2>() - face.start);
    const double after = face.normal().dot(to.head<2>() - face.start);
    const bool leaves = left && (f == left->face || f == left->other);
    if (leaves || !(after < 0.0) || before < -kRounding || !(before > after)) {
      continue;
    }
    const double t = std::max(0.0, before / (before - after));
    const Vector3d at = from + t * (to - from);
    const double along = face.along.dot(at.head<2>() - face.start);
    if (t < soonest && along >= face.low - kRounding && along <= face.high + kRounding) {
      soonest = t;
      first = Spot{f, std::clamp(along, face.low, face.high), at.z()};
    }
  }
  return first;
}

std::optional<Vector3d> RubbedProfile::next(const Vector3d& tool) {
  if (!spot_) {
    spot_ = free_ ? meet(*free_, tool, {}) : std::nullopt;
  }
  // A flight may land on another face, once on each.
  for (std::size_t flight = 0; spot_ && flight <= faces_.size(); ++flight) {
    LeftFaces left{};
    if (slide(*spot_, tool, left)) {
      return place(*spot_);
    }
    spot_ = meet(place(*spot_), tool, left);
  }
  spot_.reset();
  free_ = tool;
  return std::nullopt;
}

RubbedProfile rubbed_profile(const TruePlane&, double friction) {
  return RubbedProfile({{Vector2d::Zero(), -Vector2d::UnitX(), -kEndless, kEndless}}, false,
                       friction);
}

RubbedProfile rubbed_profile(const TrueWedge& body, double friction) {
  const double c = std::cos(body.flank), s = std::sin(body.flank);
  return RubbedProfile(
      {{Vector2d::Zero(), {-c, s}, -kEndless, 0.0}, {Vector2d::Zero(), {-c, -s}, 0.0, kEndless}},
      false, friction);
}

RubbedProfile rubbed_profile(const TrueConcaveEdge& body, double friction) {
  const double c = std::cos(body.flank), s = std::sin(body.flank);
  return RubbedProfile(
      {{Vector2d::Zero(), {-c, -s}, -kEndless, 0.0}, {Vector2d::Zero(), {-c, s}, 0.0, kEndless}},
      false, friction);
}

RubbedProfile rubbed_profile(const TrueThinPlate& body, double friction) {
  const double x = 0.5 * body.width, y = 0.5 * body.thickness;
  return RubbedProfile({{{-x, -y}, Vector2d::UnitX(), 0.0, body.width},
                        {{x, -y}, Vector2d::UnitY(), 0.0, body.thickness},
                        {{x, y}, -Vector2d::UnitX(), 0.0, body.width},
                        {{-x, y}, -Vector2d::UnitY(), 0.0, body.thickness}},
                       true, friction);
}

namespace {

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
