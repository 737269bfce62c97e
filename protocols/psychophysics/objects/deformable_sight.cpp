#include "protocols/psychophysics/objects/deformable_sight.h"

#include <algorithm>
#include <map>
#include <utility>

namespace haptrial::protocols {

using deformable::Edge;
using deformable::Face;
using Eigen::Vector3d;

namespace {

/// An edge and the corners across from it: of a square's diagonal both are nearer to its middle
/// than half of its length or as near.
struct Across {
  std::vector<std::int32_t> corners;
};

bool is_diagonal(std::span<const Vector3d> at, const Edge& edge, const Across& across) {
  const auto place = [&](std::int32_t v) -> const Vector3d& {
    return at[static_cast<std::size_t>(v)];
  };
  const Vector3d middle = 0.5 * (place(edge[0]) + place(edge[1]));
  const double half = 0.5 * (place(edge[1]) - place(edge[0])).norm();
  constexpr double kRounding = 1.0 + 1e-9;
  return across.corners.size() == 2 && std::ranges::all_of(across.corners, [&](std::int32_t v) {
           return (place(v) - middle).norm() <= kRounding * half;
         });
}

std::vector<Edge> sides_of_cells(const deformable::HapticMesh& mesh) {
  std::map<Edge, Across> edges;
  for (const Face& face : mesh.felt) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = face[k], b = face[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].corners.push_back(face[(k + 2) % 3]);
    }
  }
  std::vector<Edge> sides;
  for (const auto& [edge, across] : edges) {
    if (!is_diagonal(mesh.tets.vertices, edge, across)) {
      sides.push_back(edge);
    }
  }
  return sides;
}

}  // namespace

DeformableSight::DeformableSight(SeenBody body, const contact::SharedBody& skin)
    : body_(std::move(body)) {
  const auto& rest = mesh().tets.vertices;
  coarse_.assign(rest.begin(), rest.end());
  if (body_.resting) {
    place_.assign(coarse_.size(), -1);
    for (std::size_t i = 0; i < body_.resting->places(); ++i) {
      const auto place = static_cast<std::int32_t>(i);
      place_[static_cast<std::size_t>(body_.resting->vertex(place))] = place;
    }
  }
  const std::vector<Face> outer = deformable::mesh_parts(mesh().tets.tetrahedra).surface;
  if (skin) {
    fine_ = skin->mesh.vertices;
    skin_ = std::make_unique<deformable::Skin>(coarse_, outer, fine_);
    triangles_ = skin->mesh.triangles;
  } else {
    triangles_ = outer;
    grid_ = sides_of_cells(mesh());
  }
}

const deformable::HapticMesh& DeformableSight::mesh() const {
  return body_.resting ? body_.resting->mesh() : *body_.moving->mesh;
}

void DeformableSight::update(std::span<const SeenForces::Force> forces) {
  if (body_.resting) {
    press(forces);
  } else if (!body_.shape->read(coarse_)) {
    return;
  }
  if (skin_) {
    skin_->update(coarse_, fine_);
  }
}

void DeformableSight::press(std::span<const SeenForces::Force> forces) {
  const deformable::Compliance& body = *body_.resting;
  for (std::size_t i = 0; i < body.places(); ++i) {
    const auto place = static_cast<std::int32_t>(i);
    Eigen::Vector3f u = Eigen::Vector3f::Zero();
    for (const SeenForces::Force& force : forces) {
      const auto vertex = static_cast<std::size_t>(force.vertex);
      const std::int32_t touched = vertex < place_.size() ? place_[vertex] : -1;
      if (touched >= 0 && static_cast<std::size_t>(touched) < body.touched()) {
        u += body.response(place, touched, Eigen::Vector3f(force.newtons.data()));
      }
    }
    coarse_[static_cast<std::size_t>(body.vertex(place))] = body.rest(place) + u.cast<double>();
  }
}

}  // namespace haptrial::protocols
