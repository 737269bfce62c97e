#include "analysis/contact/truth/true_contact.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "analysis/contact/truth/sliding_profile.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void require_truth(bool good, const char* sentence) {
  if (!good) {
    throw std::invalid_argument(sentence);
  }
}
bool length_above_0(double x) { return x > 0.0 && std::isfinite(x); }
bool good_flank(double x) { return x > 0.0 && x < 0.5 * std::numbers::pi; }

/// Where the proxy is for a tool that is inside; nothing for one in the air. One for each body;
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
  explicit SphereProxy(const TrueSphere& body) : radius_(body.radius) {
    require_truth(length_above_0(radius_), "radius must be above 0");
  }
  std::optional<Vector3d> next(const Vector3d& p) const {
    return p.norm() < radius_ ? std::optional(Vector3d(radius_ * p.normalized())) : std::nullopt;
  }

 private:
  double radius_;
};

class CylinderProxy {
 public:
  explicit CylinderProxy(const TrueCylinder& body) : radius_(body.radius) {
    require_truth(length_above_0(radius_), "radius must be above 0");
  }
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
  explicit TorusProxy(const TrueTorus& body) : body_(body) {
    require_truth(length_above_0(body.radius) && length_above_0(body.tube_radius) &&
                      body.tube_radius < body.radius,
                  "radii of a torus must be above 0, the tube's the smaller one");
  }
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

/// What is outside of a concave edge is convex: its nearest point is the only one.
class ConcaveProxy {
 public:
  explicit ConcaveProxy(const TrueConcaveEdge& body) {
    require_truth(good_flank(body.flank), "flank must lie inside (0, pi / 2)");
    normal_ = {-std::sin(body.flank), std::cos(body.flank)};  // of the face at x > 0
  }
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
  Vector2d normal_;
};

/// A body that is the same all along z.
class ProfileProxy {
 public:
  explicit ProfileProxy(const TrueWedge& body)
      : profile_((require_truth(good_flank(body.flank), "flank must lie inside (0, pi / 2)"),
                  wedge_profile(body.flank))) {}
  explicit ProfileProxy(const TrueThinPlate& body)
      : profile_((require_truth(length_above_0(body.width) && length_above_0(body.thickness),
                                "width and thickness must be above 0"),
                  plate_profile(body.width, body.thickness))) {}

  std::optional<Vector3d> next(const Vector3d& p) {
    const auto on = profile_.next(p.head<2>());
    return on ? std::optional(Vector3d(on->x(), on->y(), p.z())) : std::nullopt;
  }

 private:
  ConvexProfile profile_;
};

class WavyProxy {
 public:
  explicit WavyProxy(const TrueWavyPlate& body) : profile_(body.height, body.length) {
    require_truth(length_above_0(body.height) && length_above_0(body.length),
                  "height and length must be above 0");
  }
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

/// A point that keeps its place while the force is in the cone.
class RubbedPlane {
 public:
  Vector3d touch(const Vector3d& from, const Vector3d& p) const {
    const Vector3d at = from + from.y() / (from.y() - p.y()) * (p - from);
    return {at.x(), 0.0, at.z()};
  }
  Vector3d slide(const Vector3d& proxy, const Vector3d& p, double friction) const {
    const Vector3d foot(p.x(), 0.0, p.z());
    const double reach = friction * -p.y(), far = (proxy - foot).norm();
    return far <= reach ? proxy : Vector3d(foot + reach / far * (proxy - foot));
  }
};

class RubbedSphere {
 public:
  explicit RubbedSphere(double radius) : radius_(radius) {}

  Vector3d touch(const Vector3d& from, const Vector3d& p) const {
    const Vector3d way = p - from;
    const double a = way.squaredNorm(), b = from.dot(way);
    const double c = from.squaredNorm() - radius_ * radius_;
    const double t = c / (-b + std::sqrt(std::max(0.0, b * b - a * c)));
    return radius_ * (from + t * way).normalized();
  }
  /// In the triangle of centre, tool and proxy the angle at the proxy is that of the cone, φ:
  /// sin(angle at the tool) / R = sin φ / |p|, so that the proxy is asin(R sin φ / |p|) - φ from
  /// the tool's direction.
  Vector3d slide(const Vector3d& proxy, const Vector3d& p, double friction) const {
    const double cone = std::atan(friction), ratio = radius_ * std::sin(cone) / p.norm();
    const double apart = std::atan2(proxy.cross(p).norm(), proxy.dot(p));
    if (ratio >= 1.0 || apart <= std::asin(ratio) - cone) {
      return proxy;  // near the centre the cone of every place holds the tool
    }
    const double reach = std::asin(ratio) - cone;
    const Vector3d along = p.normalized();
    const Vector3d across = (proxy - proxy.dot(along) * along).normalized();
    return radius_ * (std::cos(reach) * along + std::sin(reach) * across);
  }

 private:
  double radius_;
};

void check_tool(std::span<const Vector3d> tool, double stiffness) {
  require_truth(length_above_0(stiffness), "stiffness must be above 0 and finite");
  for (const auto& p : tool) {
    require_truth(p.allFinite(), "tool positions must be finite");
  }
}

TrueContact contact_at(const std::optional<Vector3d>& proxy, const Vector3d& p, double stiffness) {
  return proxy ? TrueContact{true, *proxy, stiffness * (*proxy - p)}
               : TrueContact{false, p, Vector3d::Zero()};
}

template <class Inside, class Rubbed>
std::vector<TrueContact> rubbed_contacts(const Inside& inside, const Rubbed& surface,
                                         std::span<const Vector3d> tool, double stiffness,
                                         double friction) {
  check_tool(tool, stiffness);
  require_truth(friction >= 0.0 && std::isfinite(friction), "friction must not be negative");
  std::vector<TrueContact> contacts;
  for (std::size_t i = 0; i < tool.size(); ++i) {
    std::optional<Vector3d> proxy;
    if (inside(tool[i])) {
      require_truth(i > 0, "the first tool position must be in the air");
      const Vector3d before =
          contacts.back().touching ? contacts.back().proxy : surface.touch(tool[i - 1], tool[i]);
      proxy = surface.slide(before, tool[i], friction);
    }
    contacts.push_back(contact_at(proxy, tool[i], stiffness));
  }
  return contacts;
}

}  // namespace

std::vector<TrueContact> true_contacts(const TrueBody& body, std::span<const Vector3d> tool,
                                       double stiffness) {
  check_tool(tool, stiffness);
  return std::visit(
      [&](const auto& one) {
        auto proxy = proxy_of(one);
        std::vector<TrueContact> contacts;
        for (const auto& p : tool) {
          contacts.push_back(contact_at(proxy.next(p), p, stiffness));
          require_truth(!contacts.front().touching, "the first tool position must be in the air");
        }
        return contacts;
      },
      body);
}

std::vector<TrueContact> true_contacts(const TruePlane&, std::span<const Vector3d> tool,
                                       double stiffness, double friction) {
  return rubbed_contacts([](const Vector3d& p) { return p.y() < 0.0; }, RubbedPlane(), tool,
                         stiffness, friction);
}

std::vector<TrueContact> true_contacts(const TrueSphere& body, std::span<const Vector3d> tool,
                                       double stiffness, double friction) {
  const double radius = body.radius;
  require_truth(length_above_0(radius), "radius must be above 0");
  return rubbed_contacts([radius](const Vector3d& p) { return p.norm() < radius; },
                         RubbedSphere(radius), tool, stiffness, friction);
}

}  // namespace haptrial::evaluation
