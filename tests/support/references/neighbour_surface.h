#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::bone {

/// The surface as the source makes it, to compare ours with: a vertex at the centre of each surface
/// voxel (filled, with an empty one among its 26 neighbours); a triangle of every three surface
/// voxels that are neighbours of one another, turned towards the side that is emptier; and without
/// those that lie under the surface: where a filled voxel of the same 2 x 2 x 2 ones lies above.
/// Source: Morris 2006, §3.2.2.
class NeighbourSurface {
 public:
  explicit NeighbourSurface(const BoneVolume& volume) : volume_(volume) {
    find_voxels();
    for (const auto& [key, number] : numbers_) {
      add_triangles(Voxel(key[2], key[1], key[0]), number);
    }
  }
  const geometry::Mesh& mesh() const { return mesh_; }

 private:
  using Key = std::array<int, 3>;  // z, y, x: the source's index, so that order is by index
  static Key key(const Voxel& v) { return {v.z(), v.y(), v.x()}; }
  bool filled(const Voxel& v) const { return volume_.density(v) > 0.0F; }

  template <class Visit>
  static void for_neighbours(const Voxel& v, Visit&& visit) {
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          if (i != 0 || j != 0 || k != 0) {
            visit(Voxel(v + Voxel(i, j, k)));
          }
        }
      }
    }
  }

  void find_voxels() {
    const geometry::VoxelGrid& grid = volume_.grid();
    for (std::int32_t at = BoneVolume::kBrickVoxels;
         at < volume_.bricks() * BoneVolume::kBrickVoxels; ++at) {
      const Voxel v = volume_.voxel_at(at);
      Eigen::Vector3d out = Eigen::Vector3d::Zero();
      bool surface = false;
      if (volume_.density(at) > 0.0F) {
        for_neighbours(v, [&](const Voxel& n) {
          if (!filled(n)) {
            surface = true;
            out += (n - v).cast<double>();
          }
        });
      }
      if (surface) {
        numbers_.emplace(key(v), 0);
        out_.emplace(key(v), out);
      }
    }
    for (auto& [k, number] : numbers_) {
      number = static_cast<std::int32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(grid.centre(k[2], k[1], k[0]));
    }
  }

  void add_triangles(const Voxel& a, std::int32_t first) {
    for_neighbours(a, [&](const Voxel& b) {
      const auto second = numbers_.find(key(b));
      if (second == numbers_.end() || second->second <= first) {
        return;
      }
      for_neighbours(b, [&](const Voxel& c) {
        const auto third = numbers_.find(key(c));
        if (third == numbers_.end() || third->second <= second->second ||
            (c - a).cwiseAbs().maxCoeff() > 1) {
          return;
        }
        add_triangle(a, b, c, {first, second->second, third->second});
      });
    });
  }

  void add_triangle(const Voxel& a, const Voxel& b, const Voxel& c, geometry::Triangle t) {
    Voxel normal = (b - a).cross(c - a);
    const Eigen::Vector3d out = out_.at(key(a)) + out_.at(key(b)) + out_.at(key(c));
    if (normal.cast<double>().dot(out) < 0.0) {
      std::swap(t[1], t[2]);
      normal = -normal;
    }
    const Voxel low = a.cwiseMin(b).cwiseMin(c);
    const Voxel high = a.cwiseMax(b).cwiseMax(c);
    for (int k = high.z() - 1; k <= low.z() + 1; ++k) {
      for (int j = high.y() - 1; j <= low.y() + 1; ++j) {
        for (int i = high.x() - 1; i <= low.x() + 1; ++i) {
          const Voxel v(i, j, k);
          if (normal.dot(v - a) > 0 && filled(v)) {
            return;
          }
        }
      }
    }
    mesh_.triangles.push_back(t);
  }

  const BoneVolume& volume_;
  std::map<Key, std::int32_t> numbers_;
  std::map<Key, Eigen::Vector3d> out_;
  geometry::Mesh mesh_;
};

}  // namespace haptrial::bone
