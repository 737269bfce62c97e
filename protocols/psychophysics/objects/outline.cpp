#include "protocols/psychophysics/objects/outline.h"

#include <Eigen/Geometry>
#include <map>

namespace haptrial::protocols {

using Eigen::Vector3d;

namespace {

constexpr double kCrease = 0.8;  // cosine between two faces: 37 degrees

struct Side {
  Vector3d first = Vector3d::Zero(), second = Vector3d::Zero();  // normals of its triangles
  int triangles{0};
};

Vector3d normal_of(const geometry::Mesh& mesh, const geometry::Triangle& t) {
  const Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  return (mesh.vertices[static_cast<std::size_t>(t[1])] - a)
      .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a)
      .stableNormalized();
}

/// The front side of a crease, or the rim of what is seen.
bool is_drawn(const Side& side, const Vector3d& along) {
  if (side.triangles != 2) {
    return true;
  }
  const bool first_in_front = side.first.dot(along) < 0.0;
  const bool second_in_front = side.second.dot(along) < 0.0;
  const bool crease = side.first.dot(side.second) < kCrease;
  return first_in_front != second_in_front || (crease && first_in_front);
}

}  // namespace

Outline outline_of(const geometry::Mesh& mesh, const SeenObject& seen, const Vector3d& along) {
  const Eigen::Quaterniond turn(seen.turn[0], seen.turn[1], seen.turn[2], seen.turn[3]);
  const Vector3d centre = Eigen::Vector3f(seen.centre.data()).cast<double>();
  const Vector3d local = turn.conjugate() * along;
  std::map<std::pair<std::int32_t, std::int32_t>, Side> sides;
  for (const geometry::Triangle& t : mesh.triangles) {
    const Vector3d normal = normal_of(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      Side& side = sides[std::minmax(t[k], t[(k + 1) % 3])];
      (side.triangles == 0 ? side.first : side.second) = normal;
      ++side.triangles;
    }
  }
  const auto placed = [&](std::int32_t vertex) {
    const Vector3d& p = mesh.vertices[static_cast<std::size_t>(vertex)];
    return Vector3d(centre + static_cast<double>(seen.scale) * (turn * p));
  };
  Outline lines;
  for (const auto& [ends, side] : sides) {
    if (is_drawn(side, local)) {
      lines.emplace_back(placed(ends.first), placed(ends.second));
    }
  }
  return lines;
}

}  // namespace haptrial::protocols
