#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/instruction_set.h"

// The arithmetic of spring forces, compiled for each instruction set. All give the same bits: no
// two clusters of a pack share a vertex, so that a vertex's forces are summed in the order of
// packs.
namespace haptrial::deformable {

/// Parts that the stars of the two kinds of voxels inside of a lattice own (ClusterPacks::owned),
/// as tetrahedralize() cuts them and the last cluster owns. The kernel has code for these alone,
/// without branches; other stars are computed by code for all.
inline constexpr std::uint64_t kInLattice[] = {0x20fd083d5, 0x31c7103c7};

/// ClusterPacks as plain pointers, for code that shares nothing with other instruction sets.
struct PackView {
  std::size_t packs;
  const std::int32_t* corners;
  const std::uint64_t* owned;
  const double* constants;  // 64-byte aligned
};

struct ForceQuery {
  PackView stars;
  PackView singles;
  const double* positions;  // four numbers a vertex, the fourth unused [m]
  double* forces;           // the same; what the springs do is added [N]
};

/// @returns how many tetrahedra have a positive volume, fillers among them.
using ForceKernel = std::size_t (*)(const ForceQuery& query) noexcept;

/// @throws std::invalid_argument when this machine cannot run it.
ForceKernel force_kernel(InstructionSet set = best_instruction_set());

std::size_t add_forces_baseline(const ForceQuery& query) noexcept;
/// Exists where the compiler targets x86-64.
std::size_t add_forces_avx2(const ForceQuery& query) noexcept;

}  // namespace haptrial::deformable
