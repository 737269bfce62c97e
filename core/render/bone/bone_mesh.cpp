#include "core/render/bone/bone_mesh.h"

#include <GL/glcorearb.h>

#include <algorithm>
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

std::vector<Eigen::AlignedBox3d> slabs_of(const geometry::Mesh& mesh) {
  constexpr int kSlabs = 6;
  Eigen::AlignedBox3d all;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    all.extend(vertex);
  }
  std::vector<Eigen::AlignedBox3d> slabs(kSlabs);
  Eigen::Index axis = 0;
  const double length = all.isEmpty() ? 0.0 : all.sizes().maxCoeff(&axis);
  const auto place = [&](double at) {
    const double share = length > 0.0 ? (at - all.min()[axis]) / length : 0.0;
    return std::clamp(static_cast<int>(kSlabs * share), 0, kSlabs - 1);
  };
  for (const geometry::Triangle& triangle : mesh.triangles) {
    Eigen::AlignedBox3d box;
    for (const std::int32_t v : triangle) {
      box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
    }
    const int last = place(box.max()[axis]);
    for (int i = place(box.min()[axis]); i <= last; ++i) {
      Eigen::AlignedBox3d cut = all;
      cut.min()[axis] += length * i / kSlabs;
      cut.max()[axis] = all.min()[axis] + length * (i + 1) / kSlabs;
      cut = cut.intersection(box);
      slabs[static_cast<std::size_t>(i)].extend(cut.isEmpty() ? box : cut);
    }
  }
  return slabs;
}

BoneMesh::BoneMesh(const Gl& gl, std::shared_ptr<const geometry::Mesh> mesh)
    : gl_(gl), mesh_(std::move(mesh)), slabs_(slabs_of(*mesh_)), corners_(gl, sizeof(LitCorner)) {
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
