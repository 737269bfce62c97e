#include "analysis/contact/truth/true_contact.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "analysis/contact/truth/rubbed_profile.h"
#include "analysis/contact/truth/sliding_profile.h"
#include "core/base/require.h"

namespace haptrial::evaluation {
namespace {

bool is_length(double x) { return x > 0.0 && std::isfinite(x); }

void check(const TruePlane&) {}
void check(const TrueSphere& body) { require(is_length(body.radius), "radius must be above 0"); }
void check(const TrueCylinder& body) { require(is_length(body.radius), "radius must be above 0"); }
void check(const TrueTorus& body) {
  require(is_length(body.radius) && is_length(body.tube_radius) && body.tube_radius < body.radius,
          "radii of a torus must be above 0, the tube's the smaller one");
}
void check_flank(double flank) {
  require(flank > 0.0 && flank < 0.5 * std::numbers::pi, "flank must lie inside (0, pi / 2)");
}
void check(const TrueWedge& body) { check_flank(body.flank); }
void check(const TrueConcaveEdge& body) { check_flank(body.flank); }
void check(const TrueWavyPlate& body) {
  require(is_length(body.height) && is_length(body.length), "height and length must be above 0");
}
void check(const TrueThinPlate& body) {
  require(is_length(body.width) && is_length(body.thickness),
          "width and thickness must be above 0");
}

}  // namespace

void check_truth(const TrueBody& body, std::span<const Eigen::Vector3d> tool, double stiffness,
                 double friction) {
  std::visit([](const auto& one) { check(one); }, body);
  require(is_length(stiffness), "stiffness must be above 0 and finite");
  require(friction >= 0.0 && std::isfinite(friction), "friction must not be negative");
  for (const auto& p : tool) {
    require(p.allFinite(), "tool positions must be finite");
  }
}

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Place of the proxy for a tool that is inside; nothing for one in the air. One for each body;
/// some remember where they were.
class PlaneProxy {
 public:
  explicit PlaneProxy(const TruePlane&) {}
  std::optional<Vector3d> next(const Vector3d& p) const {
    return p.y() < 0.0 ? std::optional(Vector3d(p.x(), 0.0, p.z())) : std::nullopt;
  }
};

class SphereProxy {
 public:
  explicit SphereProxy(const TrueSphere& body) : radius_(body.radius) {}
  std::optional<Vector3d> next(const Vector3d& p) const {
    return p.norm() < radius_ ? std::optional(Vector3d(radius_ * p.normalized())) : std::nullopt;
  }

 private:
  double radius_;
};

class CylinderProxy {
 public:
  explicit CylinderProxy(const TrueCylinder& body) : radius_(body.radius) {}
  std::optional<Vector3d> next(const Vector3d& p) const {
    const Vector2d out = p.head<2>();
    if (!(out.norm() < radius_)) {
      return std::nullopt;
    }
    const Vector2d on = radius_ * out.normalized();
    return Vector3d(on.x(), on.y(), p.z());
  }

 private:
  double radius_;
};

class TorusProxy {
 public:
  explicit TorusProxy(const TrueTorus& body) : body_(body) {}
  std::optional<Vector3d> next(const Vector3d& p) const {
    const Vector2d out = body_.radius * p.head<2>().normalized();
    const Vector3d ring(out.x(), out.y(), 0.0);
    return (p - ring).norm() < body_.tube_radius
               ? std::optional(Vector3d(ring + body_.tube_radius * (p - ring).normalized()))
               : std::nullopt;
  }

 private:
  TrueTorus body_;
};

/// The space outside of a concave edge is convex: its nearest point is the only one.
class ConcaveProxy {
 public:
  explicit ConcaveProxy(const TrueConcaveEdge& body)
      : normal_(-std::sin(body.flank), std::cos(body.flank)) {}
  std::optional<Vector3d> next(const Vector3d& p) const {
    const double mirror = p.x() < 0.0 ? -1.0 : 1.0;  // the nearer face is on the tool's side
    const Vector2d q(mirror * p.x(), p.y());
    const double depth = -normal_.dot(q);
    if (!(depth > 0.0)) {
      return std::nullopt;
    }
    Vector2d on = q + depth * normal_;
    if (on.x() < 0.0) {
      on.setZero();
    }
    return Vector3d(mirror * on.x(), on.y(), p.z());
  }

 private:
  Vector2d normal_;  // of the face at x > 0
};

/// A body that is the same all along z.
class ProfileProxy {
 public:
  explicit ProfileProxy(const TrueWedge& body) : profile_(wedge_profile(body.flank)) {}
  explicit ProfileProxy(const TrueThinPlate& body)
      : profile_(plate_profile(body.width, body.thickness)) {}

  std::optional<Vector3d> next(const Vector3d& p) {
    const auto on = profile_.next(p.head<2>());
    return on ? std::optional(Vector3d(on->x(), on->y(), p.z())) : std::nullopt;
  }

 private:
  ConvexProfile profile_;
};

class WavyProxy {
 public:
  explicit WavyProxy(const TrueWavyPlate& body) : profile_(body.height, body.length) {}
  std::optional<Vector3d> next(const Vector3d& p) {
    const auto on = profile_.next(p.head<2>());
    return on ? std::optional(Vector3d(on->x(), on->y(), p.z())) : std::nullopt;
  }

 private:
  WavyProfile profile_;
};

PlaneProxy proxy_of(const TruePlane& body) { return PlaneProxy(body); }
SphereProxy proxy_of(const TrueSphere& body) { return SphereProxy(body); }
CylinderProxy proxy_of(const TrueCylinder& body) { return CylinderProxy(body); }
TorusProxy proxy_of(const TrueTorus& body) { return TorusProxy(body); }
ConcaveProxy proxy_of(const TrueConcaveEdge& body) { return ConcaveProxy(body); }
ProfileProxy proxy_of(const TrueWedge& body) { return ProfileProxy(body); }
ProfileProxy proxy_of(const TrueThinPlate& body) { return ProfileProxy(body); }
WavyProxy proxy_of(const TrueWavyPlate& body) { return WavyProxy(body); }

template <class Body>
RubbedProfile rubbed_proxy_of(const Body& body, double friction) {
  return rubbed_profile(body, friction);
}
template <class Body>
requires requires(const Body& body) { smooth_surface(body); }
RubbedSurface rubbed_proxy_of(const Body& body, double friction) {
  return RubbedSurface(smooth_surface(body), friction);
}

template <class Proxy>
std::vector<TrueContact> contacts_of(Proxy proxy, std::span<const Vector3d> tool,
                                     double stiffness) {
  std::vector<TrueContact> contacts;
  for (const Vector3d& p : tool) {
    const auto at = proxy.next(p);
    if (at && contacts.empty()) {
      throw std::invalid_argument("the first tool position must be in the air");
    }
    contacts.push_back(at ? TrueContact{true, *at, stiffness * (*at - p)}
                          : TrueContact{false, p, Vector3d::Zero()});
  }
  return contacts;
}

}  // namespace

std::vector<TrueContact> true_contacts(const TrueBody& body, std::span<const Vector3d> tool,
                                       double stiffness) {
  check_truth(body, tool, stiffness, 0.0);
  return std::visit([&](const auto& one) { return contacts_of(proxy_of(one), tool, stiffness); },
                    body);
}

std::vector<TrueContact> true_contacts(const TrueBody& body, std::span<const Vector3d> tool,
                                       double stiffness, double friction) {
  check_truth(body, tool, stiffness, friction);
  return std::visit(
      [&](const auto& one) { return contacts_of(rubbed_proxy_of(one, friction), tool, stiffness); },
      body);
}

}  // namespace haptrial::evaluation
