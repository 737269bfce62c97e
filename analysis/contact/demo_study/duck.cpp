#include "analysis/contact/demo_study/duck.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/base/random.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr double kDifference = 1e-5;  // of a direction: differences are right to 1e-10

/// A bump on the ellipsoid around a direction, as a Gaussian of the angle.
struct Bump {
  Vector3d direction;
  double height;  // [m]
  double width;   // standard deviation [rad]
};
const std::array<Bump, 5> kBumps{{{{0.55, 0.83, 0.0}, 0.034, 0.42},   // head
                                  {{0.93, 0.36, 0.0}, 0.014, 0.16},   // beak
                                  {{-0.95, 0.32, 0.0}, 0.016, 0.25},  // tail
                                  {{-0.15, 0.1, 0.98}, 0.006, 0.35},  // wings
                                  {{-0.15, 0.1, -0.98}, 0.006, 0.35}}};

double ellipsoid(const Vector3d& d) {
  return 1.0 / Vector3d(d.x() / 0.050, d.y() / 0.034, d.z() / 0.036).norm();
}

/// Vertices that share a triangle, for each vertex.
std::vector<std::vector<std::int32_t>> neighbours(const geometry::Mesh& mesh) {
  std::vector<std::vector<std::int32_t>> found(mesh.vertices.size());
  for (const geometry::Triangle& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      found[static_cast<std::size_t>(t[c])].push_back(t[(c + 1) % 3]);
    }
  }
  return found;
}

}  // namespace

double duck_radius(const Vector3d& direction) {
  double radius = ellipsoid(direction);
  for (const Bump& bump : kBumps) {
    const double angle =
        std::acos(std::clamp(direction.dot(bump.direction.normalized()), -1.0, 1.0));
    radius += bump.height * std::exp(-0.5 * angle * angle / (bump.width * bump.width));
  }
  return radius;
}

Vector3d radial_normal(const RadialBody& body, const Vector3d& direction) {
  const Vector3d d = direction.normalized();
  const Vector3d u = d.unitOrthogonal(), v = d.cross(u);
  const double radius = body(d);
  const auto slope = [&](const Vector3d& along) {
    return (body((d + kDifference * along).normalized()) -
            body((d - kDifference * along).normalized())) /
           (2.0 * kDifference);
  };
  return (d - slope(u) / radius * u - slope(v) / radius * v).normalized();
}

geometry::Mesh radial_mesh(const RadialBody& body, int frequency) {
  geometry::Mesh mesh = geometry::make_sphere(1.0, frequency);
  for (Vector3d& v : mesh.vertices) {
    v = body(v.normalized()) * v.normalized();
  }
  return mesh;
}

geometry::Mesh scanned_mesh(const RadialBody& body, const ScanOptions& options) {
  geometry::Mesh mesh = geometry::make_sphere(1.0, options.frequency);
  RandomStream random(options.seed, "scan");
  // The error is smoothed: the shape keeps its curvature, as with a basis that knows it.
  std::vector<double> error;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    error.push_back(options.noise * random.normal());
  }
  const auto around = neighbours(mesh);
  for (int pass = 0; pass < options.smoothing; ++pass) {
    std::vector<double> next = error;
    for (std::size_t i = 0; i < next.size(); ++i) {
      for (const std::int32_t j : around[i]) {
        next[i] += error[static_cast<std::size_t>(j)];
      }
      next[i] /= 1.0 + static_cast<double>(around[i].size());
    }
    error.swap(next);
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d d = mesh.vertices[i].normalized();
    mesh.vertices[i] = (body(d) + error[i]) * d;
  }
  return mesh;
}

RadialBody radius_of(const geometry::Bvh& mesh) {
  return [&mesh](const Vector3d& direction) {
    const auto hit = mesh.nearest_hit({Vector3d::Zero(), direction.normalized()});
    if (!hit) {
      throw std::invalid_argument("every ray from the origin must leave the body");
    }
    return hit->t;
  };
}

}  // namespace haptrial::evaluation
