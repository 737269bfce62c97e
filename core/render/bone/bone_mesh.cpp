#include "core/render/bone/bone_mesh.h"

#include <GL/glcorearb.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>

namespace haptrial::render {
namespace {

std::array<float, 3> floats(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

std::vector<LitCorner> lit_corners(const geometry::Mesh& mesh) {
  const double smooth = std::cos(40.0 * M_PI / 180.0);
  std::vector<Eigen::Vector3d> across;  // normals as long as the triangles are large
  std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    across.push_back(
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]));
    for (const std::int32_t v : {a, b, c}) {
      around[static_cast<std::size_t>(v)].push_back(t);
    }
  }
  std::vector<LitCorner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d own = across[t].stableNormalized();
    for (const std::int32_t v : mesh.triangles[t]) {
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      for (const std::size_t other : around[static_cast<std::size_t>(v)]) {
        if (across[other].stableNormalized().dot(own) >= smooth) {
          normal += across[other];
        }
      }
      corners.push_back({floats(mesh.vertices[v]), floats(normal.stableNormalized())});
    }
  }
  return corners;
}

BoneMesh::BoneMesh(const Gl& gl, std::shared_ptr<const geometry::Mesh> mesh)
    : gl_(gl), mesh_(std::move(mesh)), corners_(gl, sizeof(LitCorner)) {
  const std::vector<LitCorner> corners = lit_corners(*mesh_);
  count_ = static_cast<int>(corners.size());
  corners_.update(corners.size(), {}, [&](ItemRange range, std::byte* to) {
    std::memcpy(to, corners.data() + range.first, range.count * sizeof(LitCorner));
  });
  gl_.gen_vertex_arrays(1, &array_);
  gl_.bind_vertex_array(array_);
  corners_.bind(GL_ARRAY_BUFFER);
  for (unsigned index = 0; index < 2; ++index) {
    const std::size_t offset = index * sizeof(LitCorner::place);
    gl_.enable_vertex_attrib_array(index);
    gl_.vertex_attrib_pointer(index, 3, GL_FLOAT, GL_FALSE, sizeof(LitCorner),
                              reinterpret_cast<const void*>(offset));
  }
  gl_.bind_vertex_array(0);
}

BoneMesh::~BoneMesh() { gl_.delete_vertex_arrays(1, &array_); }

void BoneMesh::draw() const {
  gl_.bind_vertex_array(array_);
  gl_.draw_arrays_instanced(GL_TRIANGLES, 0, count_, 1);
  gl_.bind_vertex_array(0);
}

}  // namespace haptrial::render
