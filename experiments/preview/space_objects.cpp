#include "experiments/preview/space_objects.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "core/scene/field.h"

namespace haptrial::experiments {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostTriangles = 1500;  // of an object's mesh

Vector3d across(const Vector3d& axis) { return axis.unitOrthogonal(); }

std::vector<SpaceLine> ring(const Vector3d& centre, const Vector3d& a, const Vector3d& b) {
  constexpr int kSides = 36;
  std::vector<SpaceLine> lines;
  const auto at = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    return Vector3d(centre + std::cos(angle) * a + std::sin(angle) * b);
  };
  for (int i = 0; i < kSides; ++i) {
    lines.emplace_back(at(i), at(i + 1));
  }
  return lines;
}

void append(std::vector<SpaceLine>& lines, const std::vector<SpaceLine>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

std::vector<SpaceLine> ball(const Vector3d& centre, double radius) {
  std::vector<SpaceLine> lines;
  for (int axis = 0; axis < 3; ++axis) {
    append(lines,
           ring(centre, radius * Vector3d::Unit(axis), radius * Vector3d::Unit((axis + 1) % 3)));
  }
  return lines;
}

struct OutlineOf {
  std::vector<SpaceLine> operator()(const scene::HalfSpace& half) const {
    constexpr double kShown = 0.04;  // half of the square's edge [m]
    const Vector3d a = kShown * across(half.normal.normalized());
    const Vector3d b = half.normal.normalized().cross(a);
    const std::array<Vector3d, 4> corners{half.point + a + b, half.point - a + b,
                                          half.point - a - b, half.point + a - b};
    std::vector<SpaceLine> lines;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      lines.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    }
    return lines;
  }
  std::vector<SpaceLine> operator()(const scene::Sphere& sphere) const {
    return ball(sphere.centre, sphere.radius);
  }
  std::vector<SpaceLine> operator()(const scene::Box& box) const {
    const double angle = box.turn.norm();
    const Eigen::AngleAxisd turn(
        angle, angle > 0.0 ? Vector3d(box.turn / angle) : Vector3d(Vector3d::UnitX()));
    const auto corner = [&](int i) {
      const Vector3d sign((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                          (i & 4) != 0 ? 0.5 : -0.5);
      return Vector3d(box.centre + turn * sign.cwiseProduct(box.size));
    };
    std::vector<SpaceLine> lines;
    for (int i = 0; i < 8; ++i) {
      for (const int bit : {1, 2, 4}) {
        if ((i & bit) == 0) {
          lines.emplace_back(corner(i), corner(i | bit));
        }
      }
    }
    return lines;
  }
  std::vector<SpaceLine> operator()(const scene::Cylinder& cylinder) const {
    constexpr double kEndless = 0.1;  // drawn of an endless one [m]
    const double length = std::isfinite(cylinder.length) ? cylinder.length : kEndless;
    const Vector3d axis = cylinder.axis.normalized();
    const Vector3d a = cylinder.radius * across(axis), b = axis.cross(a);
    const Vector3d half = 0.5 * length * axis;
    std::vector<SpaceLine> lines = ring(cylinder.centre + half, a, b);
    append(lines, ring(cylinder.centre - half, a, b));
    for (const Vector3d& side : {a, b, Vector3d(-a), Vector3d(-b)}) {
      lines.emplace_back(cylinder.centre + half + side, cylinder.centre - half + side);
    }
    return lines;
  }
  std::vector<SpaceLine> operator()(const scene::RegisteredShape& shape) const {
    const scene::ShapeBall around = shape.ball();
    return ball(around.centre, around.radius);
  }
};

std::vector<std::uint32_t> thinned(const geometry::Mesh& mesh, std::size_t most) {
  constexpr float kAnyError = 1.0F;  // of the whole extent: the number of triangles decides
  std::vector<std::uint32_t> corners;
  for (const geometry::Triangle& triangle : mesh.triangles) {
    for (const std::int32_t corner : triangle) {
      corners.push_back(static_cast<std::uint32_t>(corner));
    }
  }
  if (mesh.triangles.size() <= most) {
    return corners;
  }
  std::vector<float> places;
  for (const Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      places.push_back(static_cast<float>(vertex[axis]));
    }
  }
  std::vector<std::uint32_t> fewer(corners.size());
  fewer.resize(meshopt_simplify(fewer.data(), corners.data(), corners.size(), places.data(),
                                mesh.vertices.size(), 3 * sizeof(float), 3 * most, kAnyError, 0,
                                nullptr));
  return fewer;
}

std::vector<SpaceLine> moved(std::vector<SpaceLine> lines, const contact::ObjectPose& pose,
                             double scale) {
  for (auto& [from, to] : lines) {
    from = pose.position + pose.orientation * (scale * from);
    to = pose.position + pose.orientation * (scale * to);
  }
  return lines;
}

geometry::Mesh felt_faces(const deformable::HapticMesh& body) {
  geometry::Mesh mesh;
  mesh.vertices.assign(body.tets.vertices.begin(), body.tets.vertices.end());
  for (const auto& face : body.felt) {
    mesh.triangles.push_back({face[0], face[1], face[2]});
  }
  return mesh;
}

/// Outline of what a field is, if it is something in space.
std::vector<SpaceLine> lines_of_field(const scene::Field& field) {
  if (const auto* surface = std::get_if<scene::SurfaceParameters>(&field.kind)) {
    return lines_of(surface->shape);
  }
  if (const auto* rigid = std::get_if<scene::RigidObjectParameters>(&field.kind);
      rigid != nullptr && rigid->body) {
    return moved(lines_of(rigid->body->mesh, kMostTriangles), rigid->pose, rigid->scale);
  }
  if (const auto* soft = std::get_if<scene::DeformableObjectParameters>(&field.kind);
      soft != nullptr && soft->mesh) {
    return moved(lines_of(felt_faces(*soft->mesh), kMostTriangles), soft->pose, 1.0);
  }
  if (const auto* path = std::get_if<scene::PathParameters>(&field.kind)) {
    return lines_of(path->points);
  }
  if (const auto* curve = std::get_if<scene::CurveParameters>(&field.kind)) {
    return lines_of(curve->points);
  }
  return {};
}

std::vector<SpaceObject> objects_in(const protocols::PreviewedInterval& interval, int number) {
  std::vector<SpaceObject> all;
  for (const scene::Field& field : interval.presented.fields) {
    all.push_back({field.name, number, lines_of_field(field)});
  }
  for (const scene::Region& region : interval.presented.regions) {
    all.push_back({region.name, number, lines_of(region.shape)});
  }
  std::erase_if(all, [](const SpaceObject& object) { return object.lines.empty(); });
  return all;
}

}  // namespace

std::vector<SpaceLine> lines_of(const scene::Shape& shape) {
  return std::visit(OutlineOf{}, shape);
}

std::vector<SpaceLine> lines_of(const geometry::Mesh& mesh, std::size_t most_triangles) {
  const std::vector<std::uint32_t> corners = thinned(mesh, most_triangles);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t first = 0; first + 2 < corners.size(); first += 3) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[first + i], corners[first + (i + 1) % 3]);
      edges.emplace(low, high);
    }
  }
  std::vector<SpaceLine> lines;
  for (const auto& [from, to] : edges) {
    lines.emplace_back(mesh.vertices[from], mesh.vertices[to]);
  }
  return lines;
}

std::vector<SpaceLine> lines_of(const std::vector<Vector3d>& points) {
  std::vector<SpaceLine> lines;
  for (std::size_t i = 1; i < points.size(); ++i) {
    lines.emplace_back(points[i - 1], points[i]);
  }
  return lines;
}

std::vector<SpaceObject> objects_of(const protocols::PreviewedTrial& trial) {
  std::vector<SpaceObject> all;
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    for (SpaceObject& object : objects_in(trial.intervals[i], static_cast<int>(i + 1))) {
      const auto same = std::ranges::find_if(all, [&](const SpaceObject& other) {
        return other.name == object.name && other.lines == object.lines;
      });
      if (same == all.end()) {
        all.push_back(std::move(object));
      } else {
        same->interval = 0;
      }
    }
  }
  return all;
}

std::string line_numbers(const std::vector<SpaceLine>& lines) {
  constexpr double kUnits = 1e4;  // in a metre
  std::string text;
  for (const auto& [from, to] : lines) {
    text += fmt::format("{}{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.0f}", text.empty() ? "" : ";",
                        kUnits * from.x(), kUnits * from.y(), kUnits * from.z(), kUnits * to.x(),
                        kUnits * to.y(), kUnits * to.z());
  }
  return text;
}

}  // namespace haptrial::experiments
