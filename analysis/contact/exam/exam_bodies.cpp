#include "analysis/contact/exam/exam_bodies.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/mesh/procedural.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Mesh;

constexpr double kFlank = 0.6;  // [rad]
constexpr double kHalf = 0.1;   // of a body that is endless along z [m]
constexpr double kFloor = 0.1;  // below the lowest corner of a body that is endless downwards [m]

double sway(double t) { return 0.02 * std::sin(2.3 * t); }
double dip(double t) { return 0.004 * std::cos(5.0 * t) - 0.0035 * (1.0 - std::exp(-t)); }

Vector3d over_plane(double t) { return {sway(t), dip(t), 0.3 * sway(2.0 * t)}; }
Vector3d over_sphere(double t) {
  const double a = 0.4 + sway(t) / 0.02, b = 0.6 * std::sin(t);
  return (0.05 + dip(t)) *
         Vector3d(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
}
Vector3d over_cylinder(double t) {
  const double a = sway(t) / 0.02;
  return {(0.03 + dip(t)) * std::cos(a), (0.03 + dip(t)) * std::sin(a), sway(1.7 * t)};
}
Vector3d over_torus(double t) {
  const double a = sway(t) / 0.02, b = 2.0 * std::sin(0.9 * t), r = 0.015 + dip(t);
  const double out = 0.04 + r * std::cos(b);
  return {out * std::cos(a), out * std::sin(a), r * std::sin(b)};
}
Vector3d over_wedge(double t) {
  const double x = 0.4 * sway(t);
  return {x, -0.684 * std::abs(x) + dip(t), sway(0.7 * t)};
}
Vector3d over_concave_edge(double t) {
  const double x = 0.4 * sway(t);
  return {x, 0.684 * std::abs(x) + dip(t), sway(0.7 * t)};
}
Vector3d over_wavy_plate(double t) { return {sway(t), 0.4 * dip(t) + 0.0006, sway(0.7 * t)}; }
/// Presses through the plate to below it, then drags the contact round the rim.
Vector3d through_thin_plate(double t) {
  return {0.005 + 0.0034 * t, 0.002 - 0.003 * std::min(t, 1.5), 0.002 * t};
}

void add_quad(Mesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// A solid along z between a profile, from left to right, and a floor below it.
Mesh extruded(const std::vector<Vector2d>& profile, double floor) {
  Mesh mesh;
  for (const Vector2d& c : profile) {
    for (const double y : {c.y(), floor}) {
      mesh.vertices.emplace_back(c.x(), y, -kHalf);
      mesh.vertices.emplace_back(c.x(), y, kHalf);
    }
  }
  const auto last = static_cast<std::int32_t>(4 * (profile.size() - 1));
  for (std::int32_t i = 0; i < last; i += 4) {
    const std::int32_t j = i + 4;
    add_quad(mesh, i, i + 1, j + 1, j);          // the profile
    add_quad(mesh, i + 2, j + 2, j + 3, i + 3);  // the floor
    add_quad(mesh, i, j, j + 2, i + 2);          // the end at -z
    add_quad(mesh, i + 1, i + 3, j + 3, j + 1);  // the end at +z
  }
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, last, last + 1, last + 3, last + 2);
  return mesh;
}

double lowest_of(const std::vector<Vector2d>& profile) {
  return std::ranges::min(profile, {}, [](const Vector2d& p) { return p.y(); }).y();
}

Mesh ground(const std::vector<Vector2d>& profile) {
  return extruded(profile, lowest_of(profile) - kFloor);
}

struct MeshMaker {
  int fine;

  Mesh operator()(const TruePlane&) const { return ground({{-0.1, 0.0}, {0.1, 0.0}}); }
  Mesh operator()(const TrueSphere& b) const { return geometry::make_sphere(b.radius, 10 * fine); }
  Mesh operator()(const TrueCylinder& b) const {
    const std::int32_t count = 60 * fine;
    Mesh mesh;
    for (std::int32_t i = 0; i < count; ++i) {
      const double a = 2.0 * std::numbers::pi * i / count;
      mesh.vertices.emplace_back(b.radius * std::cos(a), b.radius * std::sin(a), -kHalf);
      mesh.vertices.emplace_back(b.radius * std::cos(a), b.radius * std::sin(a), kHalf);
    }
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t a = 2 * i, c = 2 * ((i + 1) % count);
      add_quad(mesh, a, c, c + 1, a + 1);
      mesh.triangles.push_back({2 * count, c, a});
      mesh.triangles.push_back({2 * count + 1, a + 1, c + 1});
    }
    mesh.vertices.emplace_back(0.0, 0.0, -kHalf);
    mesh.vertices.emplace_back(0.0, 0.0, kHalf);
    return mesh;
  }
  Mesh operator()(const TrueTorus& b) const {
    return geometry::make_torus(b.radius, b.tube_radius, 80 * fine, 40 * fine);
  }
  Mesh operator()(const TrueWedge& b) const {
    const double c = 0.1 * std::cos(b.flank), s = 0.1 * std::sin(b.flank);
    return ground({{-c, -s}, {0.0, 0.0}, {c, -s}});
  }
  Mesh operator()(const TrueConcaveEdge& b) const {
    const double c = 0.1 * std::cos(b.flank), s = 0.1 * std::sin(b.flank);
    return ground({{-c, s}, {0.0, 0.0}, {c, s}});
  }
  Mesh operator()(const TrueWavyPlate& b) const {
    std::vector<Vector2d> profile;
    const int count = 120 * fine;
    for (int i = 0; i <= count; ++i) {
      const double x = 0.12 * i / count - 0.06;
      profile.emplace_back(x, b.height * std::sin(2.0 * std::numbers::pi * x / b.length));
    }
    return ground(profile);
  }
  Mesh operator()(const TrueThinPlate& b) const {
    const double x = 0.5 * b.width, y = 0.5 * b.thickness;
    return extruded({{-x, y}, {x, y}}, -y);
  }
};

}  // namespace

const std::vector<ExamBody>& exam_bodies() {
  static const std::vector<ExamBody> bodies{
      {"plane", TruePlane{}, over_plane},
      {"sphere", TrueSphere{0.05}, over_sphere},
      {"cylinder", TrueCylinder{0.03}, over_cylinder},
      {"torus", TrueTorus{0.04, 0.015}, over_torus},
      {"wedge", TrueWedge{kFlank}, over_wedge},
      {"concave edge", TrueConcaveEdge{kFlank}, over_concave_edge},
      {"wavy plate", TrueWavyPlate{0.001, 0.02}, over_wavy_plate},
      {"thin plate", TrueThinPlate{0.03, 0.002}, through_thin_plate}};
  return bodies;
}

std::vector<Vector3d> there_and_back(const ExamBody& body) {
  constexpr int kTicks = 4000;
  std::vector<Vector3d> points;
  for (int i = 0; i <= kTicks; ++i) {
    points.push_back(body.tool(1.5 * (1.0 - std::cos(2.0 * std::numbers::pi * i / kTicks))));
  }
  return points;
}

Mesh mesh_of(const TrueBody& body, int fine) { return std::visit(MeshMaker{fine}, body); }

}  // namespace haptrial::evaluation
