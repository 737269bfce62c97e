#include "analysis/drilling/visibility_picture.h"

#include <array>
#include <stdexcept>

#include "core/bone/bone_volume.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr render::Colour kSeen{0.25, 0.70, 0.30};
constexpr render::Colour kHidden{0.85, 0.20, 0.18};

bone::Voxel voxel_of(const geometry::VoxelGrid& grid, std::size_t index) {
  const auto x = static_cast<std::size_t>(grid.size[0]);
  const auto y = static_cast<std::size_t>(grid.size[1]);
  return {static_cast<int>(index % x), static_cast<int>(index / x % y),
          static_cast<int>(index / (x * y))};
}

/// What is drawn in a voxel: removed ones by whether they were seen, else a structure's label.
struct Drawn {
  std::vector<std::uint16_t> kinds;  // (voxels) 0: nothing
  static constexpr std::uint16_t kSeenKind = 256;
  static constexpr std::uint16_t kHiddenKind = 257;

  std::uint16_t at(const geometry::VoxelGrid& grid, const bone::Voxel& v) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (v[axis] < 0 || v[axis] >= grid.size[static_cast<std::size_t>(axis)]) {
        return 0;
      }
    }
    return kinds[grid.index(v.x(), v.y(), v.z())];
  }
};

render::Colour colour_of(const bone::BoneModel& bone, std::uint16_t kind) {
  if (kind >= Drawn::kSeenKind) {
    return kind == Drawn::kSeenKind ? kSeen : kHidden;
  }
  const auto& c = bone.structures[kind].colour;
  return {c[0], c[1], c[2]};
}

/// Two triangles of the side of a voxel that looks along an axis.
void add_side(const geometry::VoxelGrid& grid, const bone::Voxel& voxel, int axis, int way,
              const render::Colour& colour, std::vector<render::SceneTriangle>& triangles) {
  const double half = 0.5 * grid.spacing;
  const Eigen::Vector3d centre = grid.centre(voxel.x(), voxel.y(), voxel.z());
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t n = 0; n < 4; ++n) {
    corners[n] = centre;
    corners[n][axis] += way * half;
    corners[n][u] += n == 1 || n == 2 ? half : -half;
    corners[n][v] += n >= 2 ? half : -half;
  }
  triangles.push_back({{corners[0], corners[1], corners[2]}, colour, 1});
  triangles.push_back({{corners[2], corners[3], corners[0]}, colour, 1});
}

}  // namespace

std::vector<render::SceneTriangle> visibility_scene(const bone::BoneModel& bone,
                                                    std::span<const std::uint32_t> removed,
                                                    std::span<const std::uint8_t> seen,
                                                    const std::vector<bool>& labels) {
  if (removed.size() != seen.size()) {
    throw std::invalid_argument("visibility_scene: as many voxels as marks are needed");
  }
  Drawn drawn{std::vector<std::uint16_t>(bone.grid.count(), 0)};
  for (std::size_t i = 0; i < bone.labels.size(); ++i) {
    const std::uint8_t label = bone.labels[i];
    drawn.kinds[i] = label != 0 && label < labels.size() && labels[label] ? label : 0;
  }
  for (std::size_t n = 0; n < removed.size(); ++n) {
    if (removed[n] >= drawn.kinds.size()) {
      throw std::invalid_argument("visibility_scene: a voxel is outside of the grid");
    }
    drawn.kinds[removed[n]] = seen[n] != 0 ? Drawn::kSeenKind : Drawn::kHiddenKind;
  }
  std::vector<render::SceneTriangle> triangles;
  for (std::size_t i = 0; i < drawn.kinds.size(); ++i) {
    if (drawn.kinds[i] == 0) {
      continue;
    }
    const bone::Voxel voxel = voxel_of(bone.grid, i);
    const render::Colour colour = colour_of(bone, drawn.kinds[i]);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int way : {-1, 1}) {
        bone::Voxel beside = voxel;
        beside[axis] += way;
        if (drawn.at(bone.grid, beside) == 0) {
          add_side(bone.grid, voxel, axis, way, colour, triangles);
        }
      }
    }
  }
  return triangles;
}

std::vector<bool> vital_labels(const bone::BoneModel& bone) {
  std::vector<bool> labels(bone.structures.size(), false);
  for (std::size_t label = 1; label < labels.size(); ++label) {
    labels[label] = bone.structures[label].vital;
  }
  return labels;
}

}  // namespace haptrial::analysis::drilling
