#include "core/geometry/mesh/mesh_volume.h"

#include <Eigen/Geometry>

#include "core/geometry/mesh/mesh_bounds.h"

namespace haptrial::geometry {

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
