#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/body/block_matrix.h"
#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// Patches over which the strain of volume is averaged. Tetrahedra of four vertices that each keep
/// their volume lock: in a fine mesh there are more of them than there are coordinates to move.
enum class VolumeForm {
  kPatches,     // over the five tetrahedra of a cube, or six neighbours in another mesh
  kTetrahedra,  // over each tetrahedron alone: locks as nu nears 0.5
};

/// The number of each tetrahedron's patch, from 0, in ascending order of the patches' first
/// tetrahedra. A patch has tetrahedra of one material that are connected by faces. In a mesh by
/// geometry::tetrahedralize() it is the five of a cube; elsewhere patches grow to six, each time by
/// the neighbour with most corners in the patch, and what is left over joins a neighbour.
/// After: E. de Souza Neto et al., F-bar-based linear triangles and tetrahedra for finite strain
/// analysis of nearly incompressible solids, 2005.
/// @param material_of  of each tetrahedron; empty: one for all
/// @throws InputError naming a face that three tetrahedra share.
std::vector<std::int32_t> volume_patches(std::span<const geometry::Tetrahedron> tetrahedra,
                                         std::span<const std::uint8_t> material_of,
                                         VolumeForm form);

/// Patches with their vertices: the unit that forces and stiffness are computed by.
struct PatchLayout {
  std::vector<std::int32_t> first_tet;     // patches + 1: into `tets`
  std::vector<std::int32_t> tets;          // tetrahedra, patch after patch
  std::vector<std::int32_t> first_vertex;  // patches + 1: into `vertices`
  std::vector<std::int32_t> vertices;      // ascending in each patch
  /// The corners of each tetrahedron in `tets`, as places among the patch's vertices, ascending.
  std::vector<std::array<std::uint8_t, 4>> corners;

  std::size_t patches() const { return first_tet.size() - 1; }
  CoupledGroups groups() const { return {first_vertex, vertices}; }  // for a stiffness
};

PatchLayout patch_layout(std::span<const geometry::Tetrahedron> tetrahedra,
                         std::span<const std::int32_t> patch_of);

}  // namespace haptrial::deformable
