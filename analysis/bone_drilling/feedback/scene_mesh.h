#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::analysis::drilling {

/// Triangles for a page: at most 65536 vertices, so that 16 bits number them.
struct SceneMesh {
  std::vector<std::array<float, 3>> places;  // in B [m]
  std::vector<std::uint8_t> labels;          // (places)
  std::vector<std::array<std::uint16_t, 3>> triangles;
};

/// The surface of a bone in fewer triangles. @param most  triangles, above 0
SceneMesh scene_surface(const bone::BoneModel& bone, std::size_t most);

/// Mesh of all voxels that have one of some labels. @param wanted  by label; shorter: the rest is
/// not
SceneMesh scene_structure(const bone::BoneModel& bone, const std::vector<bool>& wanted,
                          std::size_t most);

/// 16-bit coordinates for a page: (place - low) / step, rounded.
struct SceneGrid {
  Eigen::Vector3d low{Eigen::Vector3d::Zero()};  // in W [m]
  double step{1e-6};                             // > 0 [m]

  /// Round all of a box. @param box  not empty
  static SceneGrid around(const Eigen::AlignedBox3d& box);
  void add(const Eigen::Vector3d& place, std::string& bytes) const;  // 6 bytes, low byte first
};

}  // namespace haptrial::analysis::drilling
