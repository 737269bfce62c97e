#include "core/geometry/mesh/mesh_bounds.h"

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

}  // namespace haptrial::geometry
