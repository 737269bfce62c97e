#pragma once

#include <cstdint>

namespace haptrial::deformable {

/// Parts that the stars of the two kinds of voxels inside of a lattice own (ClusterPacks::owned),
/// as tetrahedralize() cuts them and the last cluster owns. The kernel has code for these alone,
/// without branches; other stars are computed by code for all.
inline constexpr std::uint64_t kInLattice[] = {0x20fd083d5, 0x31c7103c7};

}  // namespace haptrial::deformable
