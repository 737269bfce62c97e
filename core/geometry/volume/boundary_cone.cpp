#include "core/geometry/volume/boundary_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/mesh/mesh_edges.h"

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

/// The loop that each step is on: a number by the root of its vertices.
class Loops {
 public:
  Loops(const Mesh& mesh, const std::vector<Step>& steps)
      : joined_(mesh.vertices.size()), number_(mesh.vertices.size(), -1) {
    for (const Step& step : steps) {
      joined_.unite(static_cast<std::uint32_t>(step.from), static_cast<std::uint32_t>(step.to));
    }
    for (const Step& step : steps) {
      std::int32_t& number = number_[joined_.root(static_cast<std::uint32_t>(step.from))];
      number = number < 0 ? count_++ : number;
    }
  }
  std::int32_t of(const Step& step) {
    return number_[joined_.root(static_cast<std::uint32_t>(step.from))];
  }
  std::int32_t count() const { return count_; }

 private:
  UnionFind joined_;
  std::vector<std::int32_t> number_;
  std::int32_t count_{0};
};

}  // namespace

BoundaryCone boundary_cone(const Mesh& mesh) {
  std::vector<Step> steps = boundary(mesh);
  Loops loops(mesh, steps);
  std::stable_sort(steps.begin(), steps.end(),
                   [&](const Step& a, const Step& b) { return loops.of(a) < loops.of(b); });
  BoundaryCone cone;
  cone.mesh.vertices = mesh.vertices;
  for (auto from = steps.begin(); from != steps.end();) {
    const auto to = std::find_if(
        from, steps.end(), [&](const Step& step) { return loops.of(step) != loops.of(*from); });
    BoundaryCone::Fan fan{cone.mesh.triangles.size(), 0, Eigen::Vector3d::Zero(), 0.0, 0.0};
    for (auto step = from; step != to; ++step) {
      fan.middle += mesh.vertices[step->from] + mesh.vertices[step->to];
    }
    fan.middle /= 2.0 * static_cast<double>(to - from);
    const auto middle = static_cast<std::int32_t>(cone.mesh.vertices.size());
    cone.mesh.vertices.push_back(fan.middle);
    for (; from != to; ++from) {
      const Triangle triangle{from->to, from->from, middle};
      fan.radius = std::max({fan.radius, (mesh.vertices[from->from] - fan.middle).norm(),
                             (mesh.vertices[from->to] - fan.middle).norm()});
      fan.area += 0.5 * from->times * doubled_area(cone.mesh, triangle);
      fan.count += static_cast<std::size_t>(from->times);
      cone.mesh.triangles.insert(cone.mesh.triangles.end(), static_cast<std::size_t>(from->times),
                                 triangle);
    }
    cone.fans.push_back(fan);
  }
  return cone;
}

double BoundaryCone::most_winding(const Fan& fan, double distance_to_middle) {
  const double distance = distance_to_middle - fan.radius;
  return distance > 0.0 ? fan.area / (4.0 * std::numbers::pi * distance * distance)
                        : std::numeric_limits<double>::infinity();
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
    const double across = a.dot(b.cross(c));
    const double along = to_a * to_b * to_c + a.dot(b) * to_c + b.dot(c) * to_a + c.dot(a) * to_b;
    sum += across == 0.0 ? 0.0 : std::atan2(across, along);  // 0: in the triangle's plane
  }
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace haptrial::geometry
