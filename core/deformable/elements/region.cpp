#include "core/deformable/elements/region.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/definition/table_vector.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-6;  // of the body's extent

Eigen::AlignedBox3d box_of(const geometry::TetMesh& body) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : body.vertices) {
    box.extend(p);
  }
  return box;
}

bool has(const Region& region, const Eigen::AlignedBox3d& box, const Vector3d& p) {
  const double near = kSame * box.sizes().maxCoeff();
  switch (region.kind) {
    case Region::Kind::kSide:
      return region.high ? p[region.axis] > box.max()[region.axis] - near
                         : p[region.axis] < box.min()[region.axis] + near;
    case Region::Kind::kBox:
      return (p.array() >= region.low.array() - near).all() &&
             (p.array() <= region.top.array() + near).all();
    case Region::Kind::kBall:
      return (p - region.centre).norm() <= region.radius + near;
    case Region::Kind::kNearest:
      break;
  }
  return false;
}

std::int32_t nearest_vertex(const geometry::TetMesh& body, const Vector3d& place) {
  const auto nearest = std::min_element(body.vertices.begin(), body.vertices.end(),
                                        [&](const Vector3d& a, const Vector3d& b) {
                                          return (a - place).norm() < (b - place).norm();
                                        });
  return static_cast<std::int32_t>(nearest - body.vertices.begin());
}

}  // namespace

Region read_region(Table& table) {
  Region region;
  if (table.has("side")) {
    region.kind = Region::Kind::kSide;
    const std::string side = table.choice("side", {"-x", "+x", "-y", "+y", "-z", "+z"});
    region.axis = side.size() == 2 ? side[1] - 'x' : 0;
    region.high = side.starts_with('+');
  } else if (table.has("nearest")) {
    region.kind = Region::Kind::kNearest;
    region.centre = read_vector(table, "nearest", {}, "m");
  } else if (table.has("centre") || table.has("radius")) {
    region.kind = Region::Kind::kBall;
    region.centre = read_vector(table, "centre", {}, "m");
    region.radius = table.number("radius", kPositive, "m");
  } else {
    region.low = read_vector(table, "low", {}, "m");
    region.top = read_vector(table, "high", {}, "m");
  }
  return region;
}

std::vector<std::int32_t> vertices_in(const Region& region, const geometry::TetMesh& body) {
  if (region.kind == Region::Kind::kNearest) {
    return {nearest_vertex(body, region.centre)};
  }
  const Eigen::AlignedBox3d box = box_of(body);
  std::vector<std::int32_t> found;
  for (std::size_t v = 0; v < body.vertices.size(); ++v) {
    if (has(region, box, body.vertices[v])) {
      found.push_back(static_cast<std::int32_t>(v));
    }
  }
  return found;
}

std::vector<Face> faces_in(const Region& region, const geometry::TetMesh& body,
                           const std::vector<Face>& surface) {
  const std::vector<std::int32_t> vertices = vertices_in(region, body);
  std::vector<Face> found;
  std::copy_if(surface.begin(), surface.end(), std::back_inserter(found), [&](const Face& face) {
    return std::all_of(face.begin(), face.end(), [&](std::int32_t v) {
      return std::binary_search(vertices.begin(), vertices.end(), v);
    });
  });
  return found;
}

}  // namespace haptrial::deformable
