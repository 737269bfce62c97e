#include "core/contact/contact_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/contact/triangle_normal.h"
#include "core/geometry/bvh/bvh_data.h"

namespace haptrial::contact {

ContactSurface::ContactSurface(const geometry::Mesh& mesh, int threads)
    : bvh_(mesh, {.threads = threads}) {
  const geometry::BvhData& data = bvh_.data();
  corners_ = data.corners.begin();
  ids_ = data.ids.begin();
  slots_ = data.slots.begin();
  double area = 0.0;
  for (const geometry::Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
    for (const std::int32_t corner : triangle) {
      magnitude_ = std::max(magnitude_, mesh.vertices[corner].cwiseAbs().maxCoeff());
    }
    area +=
        (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).stableNorm() / 2.0;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(mesh.triangles.size(), 1));
  typical_edge_ = std::sqrt(2.0 * area / count);
  find_normals(mesh);
}

void ContactSurface::find_normals(const geometry::Mesh& mesh) {
  const std::vector<Eigen::Vector3d> normals = triangle_normals(mesh, magnitude_);
  normals_.assign(bvh_.data().ids.size(), Eigen::Vector3d::Zero());
  for (std::size_t slot = 0; slot < normals_.size(); ++slot) {
    if (ids_[slot] >= 0) {
      normals_[slot] = normals[ids_[slot]];
    }
  }
}

}  // namespace haptrial::contact
