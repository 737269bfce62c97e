#include "analysis/contact/truth/smooth_surface.h"

#include <cmath>
#include <numbers>

namespace haptrial::evaluation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFlowError = 1e-14;  // of a step [m]
constexpr int kMostHalvings = 12;

Vector3d slope(const SmoothSurface& surface, const Vector3d& at, const Vector3d& tool) {
  const Vector3d on = surface.onto(at), n = surface.normal(on), pull = tool - on;
  return pull - pull.dot(n) * n;
}

Vector3d one_step(const SmoothSurface& surface, const Vector3d& from, const Vector3d& tool,
                  double time) {
  const Vector3d a = slope(surface, from, tool);
  const Vector3d b = slope(surface, from + 0.5 * time * a, tool);
  const Vector3d c = slope(surface, from + 0.5 * time * b, tool);
  const Vector3d d = slope(surface, from + time * c, tool);
  return surface.onto(from + time / 6.0 * (a + 2.0 * b + 2.0 * c + d));
}

Vector3d halved_flow(const SmoothSurface& surface, const Vector3d& from, const Vector3d& tool,
                     double time, int halvings) {
  const Vector3d middle = one_step(surface, from, tool, 0.5 * time);
  const Vector3d end = one_step(surface, middle, tool, 0.5 * time);
  if (halvings == 0 || (end - one_step(surface, from, tool, time)).norm() <= kFlowError) {
    return end;
  }
  const Vector3d half = halved_flow(surface, from, tool, 0.5 * time, halvings - 1);
  return halved_flow(surface, half, tool, 0.5 * time, halvings - 1);
}

/// On a circle of radius R with the tool at the distance r from its centre the angle θ between both
/// obeys R dθ/ds = -r sin θ: tan(θ/2) falls as exp(-s r / R).
Vector2d flow_on_circle(const Vector2d& from, const Vector2d& tool, double time) {
  const double radius = from.norm(), r = tool.norm();
  if (r == 0.0) {
    return from;
  }
  const double angle =
      std::atan2(from.x() * tool.y() - from.y() * tool.x(), from.dot(tool));  // from there to it
  const double turn = angle - 2.0 * std::atan(std::tan(0.5 * angle) * std::exp(-time * r / radius));
  const double c = std::cos(turn), s = std::sin(turn);
  return {c * from.x() - s * from.y(), s * from.x() + c * from.y()};
}

class Sphere final : public SmoothSurface {
 public:
  explicit Sphere(double radius) : radius_(radius) {}
  double height(const Vector3d& p) const override { return p.norm() - radius_; }
  Vector3d onto(const Vector3d& p) const override { return radius_ * p.normalized(); }
  Vector3d normal(const Vector3d& on) const override { return on / radius_; }
  Vector3d flow(const Vector3d& from, const Vector3d& tool, double time) const override {
    const Vector3d x = from / radius_, aside = tool - tool.dot(x) * x;
    const double length = aside.norm();
    if (length == 0.0) {
      return from;
    }
    const Vector3d y = aside / length;
    const Vector2d on = flow_on_circle({radius_, 0.0}, {tool.dot(x), length}, time);
    return on.x() * x + on.y() * y;
  }
  /// In the triangle of centre, tool and proxy the angle at the proxy is that of the cone, φ:
  /// sin(angle at the tool) / R = sin φ / |g|, so that the proxy is asin(R sin φ / |g|) - φ from
  /// the tool's direction.
  std::optional<Vector3d> cone(const Vector3d& from, const Vector3d& tool,
                               double friction) const override {
    const double open = std::atan(friction), ratio = radius_ * std::sin(open) / tool.norm();
    if (!(ratio < 1.0)) {
      return from;  // near the centre the cone of every place holds the tool
    }
    const double reach = std::asin(ratio) - open;
    const Vector3d along = tool.normalized();
    const Vector3d across = (from - from.dot(along) * along).normalized();
    return Vector3d(radius_ * (std::cos(reach) * along + std::sin(reach) * across));
  }

 private:
  double radius_;
};

class Cylinder final : public SmoothSurface {
 public:
  explicit Cylinder(double radius) : radius_(radius) {}
  double height(const Vector3d& p) const override { return p.head<2>().norm() - radius_; }
  Vector3d onto(const Vector3d& p) const override {
    const Vector2d on = radius_ * p.head<2>().normalized();
    return {on.x(), on.y(), p.z()};
  }
  Vector3d normal(const Vector3d& on) const override {
    return Vector3d(on.x(), on.y(), 0.0) / radius_;
  }
  Vector3d flow(const Vector3d& from, const Vector3d& tool, double time) const override {
    const Vector2d on = flow_on_circle(from.head<2>(), tool.head<2>(), time);
    return {on.x(), on.y(), tool.z() + std::exp(-time) * (from.z() - tool.z())};
  }

 private:
  double radius_;
};

class Torus final : public SmoothSurface {
 public:
  explicit Torus(const TrueTorus& body) : body_(body) {}
  double height(const Vector3d& p) const override {
    return (p - ring(p)).norm() - body_.tube_radius;
  }
  Vector3d onto(const Vector3d& p) const override {
    return ring(p) + body_.tube_radius * (p - ring(p)).normalized();
  }
  Vector3d normal(const Vector3d& on) const override { return (on - ring(on)).normalized(); }

 private:
  Vector3d ring(const Vector3d& p) const {
    const Vector2d out = body_.radius * p.head<2>().normalized();
    return {out.x(), out.y(), 0.0};
  }
  TrueTorus body_;
};

class WavyPlate final : public SmoothSurface {
 public:
  explicit WavyPlate(const TrueWavyPlate& body)
      : height_(body.height), wave_number_(2.0 * std::numbers::pi / body.length) {}
  double height(const Vector3d& p) const override {
    return (p.y() - level(p.x())) / std::hypot(1.0, height_ * wave_number_);
  }
  Vector3d onto(const Vector3d& p) const override { return {p.x(), level(p.x()), p.z()}; }
  Vector3d normal(const Vector3d& on) const override {
    return Vector3d(-height_ * wave_number_ * std::cos(wave_number_ * on.x()), 1.0, 0.0)
        .normalized();
  }

 private:
  double level(double x) const { return height_ * std::sin(wave_number_ * x); }
  double height_, wave_number_;
};

}  // namespace

Vector3d SmoothSurface::flow(const Vector3d& from, const Vector3d& tool, double time) const {
  return stepped_flow(*this, from, tool, time);
}

std::optional<Vector3d> SmoothSurface::cone(const Vector3d&, const Vector3d&, double) const {
  return std::nullopt;
}

Vector3d stepped_flow(const SmoothSurface& surface, const Vector3d& from, const Vector3d& tool,
                      double time) {
  return halved_flow(surface, from, tool, time, kMostHalvings);
}

std::unique_ptr<SmoothSurface> smooth_surface(const TrueSphere& body) {
  return std::make_unique<Sphere>(body.radius);
}
std::unique_ptr<SmoothSurface> smooth_surface(const TrueCylinder& body) {
  return std::make_unique<Cylinder>(body.radius);
}
std::unique_ptr<SmoothSurface> smooth_surface(const TrueTorus& body) {
  return std::make_unique<Torus>(body);
}
std::unique_ptr<SmoothSurface> smooth_surface(const TrueWavyPlate& body) {
  return std::make_unique<WavyPlate>(body);
}

}  // namespace haptrial::evaluation
