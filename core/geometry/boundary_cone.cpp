#include "core/geometry/boundary_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/geometry/mesh_edges_internal.h"

namespace haptrial::geometry {
namespace {

struct Step {  // along the boundary, in the mesh's direction
  std::int32_t from;
  std::int32_t to;
  int times;
};

std::vector<Step> boundary(const Mesh& mesh) {
  const EdgeTable edges(mesh);
  std::vector<Step> steps;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    const std::int32_t from = start_of(mesh, sides[0]);
    int net = 0;
    for (const Side side : sides) {
      net += start_of(mesh, side) == from ? 1 : -1;
    }
    if (net > 0) {
      steps.push_back({from, end_of(mesh, sides[0]), net});
    } else if (net < 0) {
      steps.push_back({end_of(mesh, sides[0]), from, -net});
    }
  }
  return steps;
}

}  // namespace

BoundaryCone boundary_cone(const Mesh& mesh) {
  const std::vector<Step> steps = boundary(mesh);
  UnionFind joined(mesh.vertices.size());
  for (const Step& step : steps) {
    joined.unite(static_cast<std::uint32_t>(step.from), static_cast<std::uint32_t>(step.to));
  }
  BoundaryCone cone;
  cone.mesh.vertices = mesh.vertices;
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);  // by root
  std::vector<double> weights;
  const auto fan = [&](const Step& step) {
    return fan_of[joined.root(static_cast<std::uint32_t>(step.from))];
  };
  for (const Step& step : steps) {
    std::int32_t& number = fan_of[joined.root(static_cast<std::uint32_t>(step.from))];
    if (number < 0) {
      number = static_cast<std::int32_t>(cone.fans.size());
      cone.fans.push_back({Eigen::Vector3d::Zero(), 0.0, 0.0});
      weights.push_back(0.0);
    }
    cone.fans[number].middle += mesh.vertices[step.from] + mesh.vertices[step.to];
    weights[number] += 2.0;
  }
  for (std::size_t f = 0; f < cone.fans.size(); ++f) {
    cone.fans[f].middle /= weights[f];
    cone.mesh.vertices.push_back(cone.fans[f].middle);
  }
  for (const Step& step : steps) {
    BoundaryCone::Fan& of_step = cone.fans[fan(step)];
    const Triangle triangle{step.to, step.from, count + fan(step)};
    of_step.radius = std::max({of_step.radius, (mesh.vertices[step.from] - of_step.middle).norm(),
                               (mesh.vertices[step.to] - of_step.middle).norm()});
    of_step.area += 0.5 * step.times * doubled_area(cone.mesh, triangle);
    cone.mesh.triangles.insert(cone.mesh.triangles.end(), static_cast<std::size_t>(step.times),
                               triangle);
  }
  return cone;
}

double winding_sum(const Mesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - point;
    const Eigen::Vector3d b = mesh.vertices[t[1]] - point;
    const Eigen::Vector3d c = mesh.vertices[t[2]] - point;
    const double to_a = a.norm();
    const double to_b = b.norm();
    const double to_c = c.norm();
    // Half of the solid angle.
    sum += std::atan2(a.dot(b.cross(c)),
                      to_a * to_b * to_c + a.dot(b) * to_c + b.dot(c) * to_a + c.dot(a) * to_b);
  }
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace haptrial::geometry
