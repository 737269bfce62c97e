#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/occupancy.h"

namespace haptrial::bone {

/// Voxels that hang together through their faces, in order of address. Never empty.
using Part = std::vector<Voxel>;

/// Which voxels of an occupancy hang together: two voxels do where they share a face (6
/// neighbours). Voxels that only meet at an edge or a corner touch in a set without area, which
/// carries no load; and a plane of voxels that is closed for walks through faces needs only half as
/// many voxels as one that is closed for diagonal steps, so a thin cut does cut.
///
/// Bricks are labelled one by one, 64 voxels an operation; then the labels of neighbouring bricks
/// are united where they meet. The result is a function of the occupancy alone.
/// The source marks what a random seed voxel reaches and calls the rest new; here the biggest part
/// is what stays (of equal ones the one with the lowest address), because which part keeps the
/// object's name should not be random. Source: Morris 2006, §3.2.6.
///
/// Any one thread at a time, with an occupancy that it owns. Keeps its memory between calls.
class Flood {
 public:
  /// Looks at what `occupancy` holds of the volume that it follows.
  void look(const BoneVolume& volume, const Occupancy& occupancy);

  /// How many parts the last look() found, and how many voxels the biggest has.
  std::size_t parts() const noexcept { return sizes_.size(); }
  std::size_t biggest() const noexcept { return sizes_.empty() ? 0 : sizes_[main_]; }

  /// All parts but the biggest, in order of their lowest addresses.
  std::vector<Part> loose(const BoneVolume& volume) const;
  /// The part that holds a voxel; empty where there is no bone.
  Part part_of(const BoneVolume& volume, const Voxel& voxel) const;
  /// All parts; the biggest one first.
  std::vector<Part> all(const BoneVolume& volume) const;

 private:
  using Bits = std::array<std::uint64_t, 8>;  // a brick's voxels, a layer of z each
  struct Cluster {
    Bits bits;
    std::int32_t brick;
  };
  void label_brick(std::int32_t brick, const Bits& held);
  void unite(std::int32_t brick, std::int32_t other, int axis);
  std::int32_t root(std::int32_t cluster) noexcept;
  void number_parts();
  std::vector<Part> collect(const BoneVolume& volume, const std::vector<bool>& wanted) const;

  std::vector<Cluster> clusters_;     // in order of brick, in it of the lowest voxel
  std::vector<std::int32_t> first_;   // by brick: its first cluster; one more at the end
  std::vector<std::int32_t> parent_;  // by cluster: union-find, the lowest is the root
  std::vector<std::int32_t> part_;    // by cluster: number of its part, by lowest cluster
  std::vector<std::size_t> sizes_;    // by part [voxels]
  std::size_t main_{0};               // the biggest part
};

}  // namespace haptrial::bone
