#include "core/contact/felt_body.h"

#include <array>
#include <mutex>
#include <utility>

#include "core/geometry/mesh/mesh_edges.h"
#include "core/geometry/mesh/mesh_size.h"

namespace haptrial::contact {
namespace {

/// On every edge lie two sides, one each way.
bool is_closed(const geometry::Mesh& mesh) {
  const geometry::EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() != 2 || start_of(mesh, sides[0]) != end_of(mesh, sides[1])) {
      return false;
    }
  }
  return edges.size() > 0;
}

}  // namespace

FeltBody::FeltBody(geometry::Mesh shape)
    : mesh(std::move(shape)),
      surface(mesh),
      distance(mesh, surface),
      size(geometry::bounds(mesh).diagonal().norm()),
      closed(is_closed(mesh)),
      facing(closed ? geometry::facing(mesh) : geometry::Facing::kOutwards) {}

SharedBody felt_body(geometry::Mesh mesh) {
  constexpr std::size_t kKept = 4;
  static std::mutex mutex;
  static std::array<SharedBody, kKept> kept;
  static std::size_t next = 0;
  const std::scoped_lock lock(mutex);
  for (const SharedBody& body : kept) {
    if (body && body->mesh.triangles == mesh.triangles && body->mesh.vertices == mesh.vertices) {
      return body;
    }
  }
  kept[next] = std::make_shared<const FeltBody>(std::move(mesh));
  return kept[std::exchange(next, (next + 1) % kKept)];
}

Eigen::Vector3d free_place(const FeltBody& body, const Eigen::Vector3d& p, double radius) noexcept {
  constexpr double kBeside = 1e-9;  // of the largest coordinate: more than its rounding
  const SurfacePoint nearest = body.distance(p);
  if (!body.closed || nearest.distance >= radius) {
    return p;
  }
  return nearest.point + (radius + kBeside * body.surface.magnitude()) * nearest.normal;
}

}  // namespace haptrial::contact
