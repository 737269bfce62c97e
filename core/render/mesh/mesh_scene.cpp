#include "core/render/mesh/mesh_scene.h"

#include <algorithm>
#include <array>

namespace haptrial::render {
namespace {

constexpr Colour kSurface{0.36, 0.68, 0.42};
constexpr Colour kWithin{0.86, 0.42, 0.36};

bool is_left(const std::optional<Cut>& cut, const Eigen::Vector3d& point) {
  return !cut || cut->normal.dot(point) <= cut->offset;
}

/// The sides of voxels that show.
class VoxelSides {
 public:
  VoxelSides(const geometry::VoxelSolid& solid, const std::optional<Cut>& cut)
      : solid_(solid), cut_(cut) {}

  std::vector<SceneTriangle> run() && {
    const auto& size = solid_.grid.size;
    for (std::int32_t k = 0; k < size[2]; ++k) {
      for (std::int32_t j = 0; j < size[1]; ++j) {
        for (std::int32_t i = 0; i < size[0]; ++i) {
          if (is_inside({i, j, k}) && is_left(cut_, solid_.grid.centre(i, j, k))) {
            add({i, j, k});
          }
        }
      }
    }
    return std::move(triangles_);
  }

 private:
  using Voxel = std::array<std::int32_t, 3>;

  bool is_inside(const Voxel& at) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (at[axis] < 0 || at[axis] >= solid_.grid.size[axis]) {
        return false;
      }
    }
    return solid_.labels[solid_.grid.index(at[0], at[1], at[2])] == geometry::VoxelLabel::kInside;
  }

  static Voxel beside(Voxel at, int side) {
    at[static_cast<std::size_t>(side / 2)] += side % 2 == 0 ? 1 : -1;
    return at;
  }

  void add(const Voxel& at) {
    bool at_surface = false;
    for (int side = 0; side < 6; ++side) {
      at_surface = at_surface || !is_inside(beside(at, side));
    }
    for (int side = 0; side < 6; ++side) {
      const Voxel other = beside(at, side);
      if (!is_inside(other) || !is_left(cut_, solid_.grid.centre(other[0], other[1], other[2]))) {
        add_side(solid_.grid.centre(at[0], at[1], at[2]), side, at_surface ? kSurface : kWithin);
      }
    }
  }

  void add_side(const Eigen::Vector3d& centre, int side, const Colour& colour) {
    const double half = 0.5 * solid_.grid.spacing;
    const Eigen::Vector3d out = (side % 2 == 0 ? half : -half) * Eigen::Vector3d::Unit(side / 2);
    const Eigen::Vector3d u = half * Eigen::Vector3d::Unit((side / 2 + 1) % 3);
    const Eigen::Vector3d v = half * Eigen::Vector3d::Unit((side / 2 + 2) % 3);
    const Eigen::Vector3d middle = centre + out;
    const std::array<Eigen::Vector3d, 4> c{middle - u - v, middle + u - v, middle + u + v,
                                           middle - u + v};
    triangles_.push_back({{c[0], c[1], c[2]}, colour, 1});
    triangles_.push_back({{c[0], c[2], c[3]}, colour, 2});
  }

  const geometry::VoxelSolid& solid_;
  const std::optional<Cut>& cut_;
  std::vector<SceneTriangle> triangles_;
};

using Face = std::array<std::int32_t, 3>;

}  // namespace

Cut halfway(const Eigen::AlignedBox3d& box, const SceneView& view) {
  const Eigen::Vector3d eye = view.towards_eye();
  Eigen::Index axis = 0;
  eye.cwiseAbs().maxCoeff(&axis);
  const Eigen::Vector3d normal = (eye[axis] < 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(axis);
  return {normal, normal.dot(box.center())};
}

std::vector<SceneTriangle> scene_of(const geometry::Mesh& mesh, const Colour& colour) {
  std::vector<SceneTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const geometry::Triangle& t : mesh.triangles) {
    triangles.push_back({{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, colour});
  }
  return triangles;
}

std::vector<SceneTriangle> scene_of(const geometry::VoxelSolid& solid,
                                    const std::optional<Cut>& cut) {
  return VoxelSides(solid, cut).run();
}

std::vector<SceneTriangle> scene_of(const geometry::TetMesh& mesh, const std::optional<Cut>& cut) {
  std::vector<Face> faces;
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    const Eigen::Vector3d middle = 0.25 * (mesh.vertices[t[0]] + mesh.vertices[t[1]] +
                                           mesh.vertices[t[2]] + mesh.vertices[t[3]]);
    if (is_left(cut, middle)) {
      for (const Face& face : {Face{t[0], t[1], t[2]}, Face{t[0], t[1], t[3]},
                               Face{t[0], t[2], t[3]}, Face{t[1], t[2], t[3]}}) {
        faces.push_back(face);
        std::sort(faces.back().begin(), faces.back().end());
      }
    }
  }
  std::sort(faces.begin(), faces.end());
  std::vector<SceneTriangle> triangles;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const bool twice =
        (f > 0 && faces[f] == faces[f - 1]) || (f + 1 < faces.size() && faces[f] == faces[f + 1]);
    if (!twice) {
      const auto [a, b, c] = faces[f];
      const bool at_surface =
          mesh.on_surface[a] != 0 && mesh.on_surface[b] != 0 && mesh.on_surface[c] != 0;
      triangles.push_back({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]},
                           at_surface ? kSurface : kWithin});
    }
  }
  return triangles;
}

}  // namespace haptrial::render
