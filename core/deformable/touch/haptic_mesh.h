#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/deformable/body/mesh_parts.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// A side of a body's box, along its own axes.
enum class BodySide : std::uint8_t {
  kLeft,
  kRight,
  kBottom,
  kTop,
  kBack,
  kFront
};  // -x +x … -z +z
std::string_view name_of(BodySide side);

/// Which vertices do not move, and where a tool may touch.
struct FeltSides {
  std::vector<BodySide> fixed{BodySide::kBottom};
  std::vector<BodySide> felt;       // empty: every outer face that is not held all over
  std::vector<BodySide> grasped{};  // the hand holds them; of bodies that move
};

/// The tetrahedra of a body that is to be felt: the same for every material.
struct HapticMesh {
  std::string name;                   // as messages call the body
  geometry::TetMesh tets;             // [m]
  std::vector<std::uint8_t> held;     // by vertex
  std::vector<std::int32_t> grasped;  // vertices that are not held
  std::vector<Face> felt;             // outer faces, normals outwards
  Eigen::AlignedBox3d box;            // [m]
  double spacing{};                   // the longest side of its cells [m]
};
using SharedHapticMesh = std::shared_ptr<const HapticMesh>;

inline constexpr double kMostFeltVertices = 1e5;  // what takes a minute or so to prepare
inline constexpr int kMostFeltCells = 200;        // along the longest side

/// Whether two bodies are the same but for what they are made of.
bool same_mesh(const HapticMesh& a, const HapticMesh& b);

/// A box about the origin of cells that are nearly cubes.
/// @param size  of its sides, > 0 [m]  @param cells  along the longest side, 2 to kMostFeltCells
/// @throws InputError naming the body: sides so thin that a cell would be flat, a body that nothing
/// holds, and one without a place to be touched.
HapticMesh felt_block(const Eigen::Vector3d& size, int cells, const FeltSides& sides,
                      std::string name);

/// The voxels inside of a closed surface: a body with steps of a voxel's side.
/// @throws InputError likewise, and as voxelize() does
HapticMesh felt_solid(const geometry::Mesh& surface, int cells, const FeltSides& sides,
                      std::string name);

/// The vertices that felt_block() would make, before anything is made.
double felt_block_vertices(const Eigen::Vector3d& size, int cells);

}  // namespace haptrial::deformable
