#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::bone {

/// Name and properties of the structure that a label stands for.
struct Structure {
  std::string name;                               // "bone", "facial nerve", ...; "" for none
  std::array<double, 3> colour{0.9, 0.87, 0.78};  // red, green, blue, 0 to 1
  double hardness{1.0};  // removal is this many times slower than in bone > 0
  bool vital{false};     // not to be touched: removing it is an injury
};

/// The name of bone that is no structure of its own.
inline constexpr const char* kPlainBone = "bone";

/// A bone as it is imported or made, before anything touches it: a dense volume in the bone frame
/// B, whose origin and axes are the grid's. Source: Morris 2006, §3.2.1.
struct BoneModel {
  std::string name;    // what it is called
  std::string source;  // where it comes from, in a sentence
  geometry::VoxelGrid grid;
  std::vector<std::uint8_t> labels;   // grid.count(); 0: nothing there, else of `structures`
  std::vector<float> density;         // grid.count(), from 0 to 1; empty: 1 wherever a label is
  std::vector<Structure> structures;  // by label; the first stands for nothing
  /// Sentences to warn with: losses of its files, and assumptions where they say nothing.
  std::vector<std::string> notes;
};

/// Whether any voxel is of a vital structure; without, nobody knows what was spared.
bool has_vital_structures(const BoneModel& model);

/// @throws std::invalid_argument naming what does not fit together: sizes, labels without a
/// structure, densities that are not from 0 to 1, density without a label or a label without.
void check(const BoneModel& model);

/// The voxels of a grid whose centres lie in a box, borders included; a grid without any voxel
/// where none does.
geometry::VoxelGrid grid_within(const geometry::VoxelGrid& grid, const Eigen::AlignedBox3d& box);

/// Leaves only what holds bone, with two empty voxels around it, where the grid has them.
void crop_to_bone(BoneModel& model);

}  // namespace haptrial::bone
