#include "core/geometry/mesh/mesh_size.h"

#include <cstdint>

namespace haptrial::geometry {

Eigen::AlignedBox3d bounds(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::int32_t corner : triangle) {
      box.extend(mesh.vertices[corner]);
    }
  }
  return box;
}

double signed_volume(const Mesh& mesh) {
  const Eigen::AlignedBox3d box = bounds(mesh);
  if (box.isEmpty()) {
    return 0.0;
  }
  const Eigen::Vector3d middle = box.center();
  double sixfold = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - middle;
    const Eigen::Vector3d b = mesh.vertices[t[1]] - middle;
    sixfold += a.dot(b.cross(mesh.vertices[t[2]] - middle));
  }
  return sixfold / 6.0;
}

}  // namespace haptrial::geometry
