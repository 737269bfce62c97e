#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/bone/surface/surface.h"

namespace haptrial::bone {

/// A model of `size` voxels a side and 1 mm each, filled where `label_of` gives a label above 0.
template <class LabelOf>
BoneModel model_of(int size, LabelOf&& label_of) {
  BoneModel model;
  model.name = "test";
  model.source = "made by a test";
  model.grid = {{size, size, size}, {0.01, -0.02, 0.03}, 0.001};
  model.structures = {{"", {0, 0, 0}}, {"bone", {0.9, 0.9, 0.8}}, {"nerve", {0.9, 0.8, 0.1}}};
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        model.labels.push_back(static_cast<std::uint8_t>(label_of(Voxel(i, j, k))));
      }
    }
  }
  return model;
}

/// A ball in the middle.
inline BoneModel ball_model(int size, double radius) {
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5 * (size - 1));
  return model_of(size, [&](const Voxel& voxel) {
    return (voxel.cast<double>() - middle).norm() <= radius ? 1 : 0;
  });
}

inline Eigen::Vector3d place_of(const SurfaceVertex& vertex) {
  return {vertex.place[0], vertex.place[1], vertex.place[2]};
}
inline Eigen::Vector3d normal_of(const SurfaceVertex& vertex) {
  return Eigen::Vector3d(vertex.normal[0], vertex.normal[1], vertex.normal[2]) / 32767.0;
}

/// Triangles with three different corners.
inline std::vector<SurfaceTriangle> living(std::span<const SurfaceTriangle> triangles) {
  std::vector<SurfaceTriangle> all;
  for (const SurfaceTriangle& t : triangles) {
    if (t[0] != t[1]) {
      all.push_back(t);
    }
  }
  return all;
}

/// How many edges are not run through as often one way as the other. A closed surface has none.
inline int open_edges(std::span<const SurfaceTriangle> triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const SurfaceTriangle& t : triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t[c];
      const std::uint32_t b = t[(c + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return static_cast<int>(std::count_if(balance.begin(), balance.end(),
                                        [](const auto& edge) { return edge.second != 0; }));
}

/// How many edges are shared by other than two triangles.
inline int branching_edges(std::span<const SurfaceTriangle> triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> shared;
  for (const SurfaceTriangle& t : triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      ++shared[std::minmax(t[c], t[(c + 1) % 3])];
    }
  }
  return static_cast<int>(std::count_if(shared.begin(), shared.end(),
                                        [](const auto& edge) { return edge.second != 2; }));
}

/// Enclosed volume by the divergence theorem; positive if triangles run anticlockwise seen from
/// outside [m3].
inline double enclosed_volume(std::span<const SurfaceVertex> vertices,
                              std::span<const SurfaceTriangle> triangles) {
  double volume = 0.0;
  const Eigen::Vector3d origin = vertices.empty() ? Eigen::Vector3d::Zero() : place_of(vertices[0]);
  for (const SurfaceTriangle& t : triangles) {
    volume +=
        (place_of(vertices[t[0]]) - origin)
            .dot((place_of(vertices[t[1]]) - origin).cross(place_of(vertices[t[2]]) - origin));
  }
  return volume / 6.0;
}

/// A surface without its slots: vertices by cell, triangles by the cells of their corners.
struct PlainSurface {
  using Key = std::array<int, 3>;
  std::map<Key, SurfaceVertex> vertices;
  std::vector<std::array<Key, 3>> triangles;  // sorted, the least corner first
  bool operator==(const PlainSurface&) const = default;
};

inline PlainSurface plain(const Surface& surface) {
  PlainSurface all;
  const auto key = [&](std::uint32_t vertex) {
    const Voxel& cell = surface.cell_of(static_cast<std::int32_t>(vertex));
    return PlainSurface::Key{cell.x(), cell.y(), cell.z()};
  };
  for (const SurfaceTriangle& t : living(surface.triangles())) {
    std::array<PlainSurface::Key, 3> corners{key(t[0]), key(t[1]), key(t[2])};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.triangles.push_back(corners);
    for (const std::uint32_t vertex : t) {
      all.vertices[key(vertex)] = surface.vertices()[vertex];
    }
  }
  std::sort(all.triangles.begin(), all.triangles.end());
  return all;
}

}  // namespace haptrial::bone
