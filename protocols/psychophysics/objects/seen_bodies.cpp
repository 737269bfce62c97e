#include "protocols/psychophysics/objects/seen_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace haptrial::protocols {
namespace {

float size_of(const SeenForces::Force& f) noexcept {
  const auto& [x, y, z] = f.newtons;
  return x * x + y * y + z * z;
}

}  // namespace

std::span<const SeenForces::Force> SeenForces::on(std::size_t i) const noexcept {
  std::size_t first = 0;
  for (std::size_t before = 0; before < i; ++before) {
    first += counts[before];
  }
  return std::span(forces).subspan(first, counts[i]);
}

void SeenForces::add(std::size_t i, std::span<const deformable::VertexForce> more) noexcept {
  std::size_t first = 0;
  for (std::size_t before = 0; before < i; ++before) {
    first += counts[before];
  }
  for (const deformable::VertexForce& each : more) {
    const Force force{each.vertex, {each.force.x(), each.force.y(), each.force.z()}};
    const auto begin = forces.begin() + static_cast<std::ptrdiff_t>(first);
    if (first + counts[i] < kMost) {
      *(begin + counts[i]++) = force;
      continue;
    }
    const auto weakest =
        std::min_element(begin, begin + counts[i],
                         [](const Force& a, const Force& b) { return size_of(a) < size_of(b); });
    if (counts[i] > 0 && size_of(*weakest) < size_of(force)) {
      *weakest = force;
    }
  }
}

std::int32_t SeenBodies::number_of(const SeenBody& body) {
  const std::lock_guard lock(mutex_);
  auto at = std::ranges::find_if(bodies_, [&](const auto& each) { return each.lock() == body; });
  if (at == bodies_.end()) {
    bodies_.push_back({body.resting, body.moving, body.shape});
    at = bodies_.end() - 1;
  }
  return static_cast<std::int32_t>(at - bodies_.begin());
}

SeenBody SeenBodies::body(std::int32_t number) const {
  const std::lock_guard lock(mutex_);
  const auto at = static_cast<std::size_t>(number);
  return number >= 0 && at < bodies_.size() ? bodies_[at].lock() : SeenBody{};
}

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
