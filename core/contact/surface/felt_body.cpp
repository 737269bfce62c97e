#include "core/contact/surface/felt_body.h"

#include <map>
#include <utility>

#include "core/geometry/mesh/mesh_bounds.h"

namespace haptrial::contact {
namespace {

/// Every side runs from a to b as often as from b to a, once each.
bool is_closed(const geometry::Mesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
  for (const geometry::Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++sides[{t[k], t[(k + 1) % 3]}];
    }
  }
  for (const auto& [side, count] : sides) {
    const auto back = sides.find({side.second, side.first});
    if (count != 1 || back == sides.end()) {
      return false;
    }
  }
  return !mesh.triangles.empty();
}

}  // namespace

FeltBody::FeltBody(geometry::Mesh shape)
    : mesh(std::move(shape)),
      surface(mesh),
      distance(mesh, surface),
      size(geometry::bounds(mesh).diagonal().norm()),
      closed(is_closed(mesh)) {}

Eigen::Vector3d free_place(const FeltBody& body, const Eigen::Vector3d& p, double radius) noexcept {
  constexpr double kBeside = 1e-9;  // of the largest coordinate: more than its rounding
  const SurfacePoint nearest = body.distance(p);
  if (!body.closed || nearest.distance >= radius) {
    return p;
  }
  return nearest.point + (radius + kBeside * body.surface.magnitude()) * nearest.normal;
}

}  // namespace haptrial::contact
