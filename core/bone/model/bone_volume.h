#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// (i, j, k) of a voxel in its grid.
using Voxel = Eigen::Vector3i;

/// Bone that can be removed: bricks of 8 x 8 x 8 voxels where there is any, found through a table
/// of the whole grid, so that a look-up is a few integer operations.
///
/// A voxel has an address: 512 times its brick's number plus its place in the brick. Brick 0 is
/// empty and stands for every place without one, also outside the grid: address 0 holds nothing
/// and is never written.
///
/// One thread, the servo thread, writes (take, put) and never allocates. Any thread may read
/// density() and version() meanwhile. Labels never change.
/// Source: Morris 2006, §3.2.2 (a hash table of voxels); why bricks: docs/decisions/0009.
class BoneVolume {
 public:
  static constexpr int kEdge = 8;
  static constexpr int kBrickVoxels = kEdge * kEdge * kEdge;

  /// All of a model. @throws std::invalid_argument as check() does.
  explicit BoneVolume(const BoneModel& model);
  /// Room in another one's grid for some of its voxels, with their labels and nothing in them yet:
  /// a voxel keeps its (i, j, k) in whatever volume it lives.
  BoneVolume(const BoneVolume& other, std::span<const Voxel> voxels);
  BoneVolume(BoneVolume&&) noexcept = default;

  const geometry::VoxelGrid& grid() const noexcept { return grid_; }
  std::int32_t bricks() const noexcept { return static_cast<std::int32_t>(origins_.size()); }
  /// The voxel with the lowest coordinates in a brick above 0.
  const Voxel& brick_origin(std::int32_t brick) const noexcept {
    return origins_[static_cast<std::size_t>(brick)];
  }

  /// Address of a voxel; 0 if there is no brick, or outside the grid. Any thread.
  std::int32_t address(const Voxel& voxel) const noexcept;
  /// The voxel at an address in a brick above 0. Any thread.
  Voxel voxel_at(std::int32_t address) const noexcept;

  /// Density of a voxel from 0 to 1. Any thread.
  float density(std::int32_t address) const noexcept {
    return std::atomic_ref<float>(densities_[address]).load(std::memory_order_relaxed);
  }
  float density(const Voxel& voxel) const noexcept { return density(address(voxel)); }
  /// Density of a voxel before anything was removed, from 0 to 1, cut off to 1/255. Any thread.
  float original(std::int32_t address) const noexcept {
    return originals_.empty()
               ? 1.0F
               : static_cast<float>(originals_[static_cast<std::size_t>(address)]) / kOriginalSteps;
  }
  float original(const Voxel& voxel) const noexcept { return original(address(voxel)); }
  std::uint8_t label(std::int32_t address) const noexcept {
    return labels_[static_cast<std::size_t>(address)];
  }
  std::uint8_t label(const Voxel& voxel) const noexcept { return label(address(voxel)); }

  /// Takes at most `amount` >= 0 of the density away. Servo thread.
  /// @returns what was taken; the voxel is empty when that was all it had.
  float take(std::int32_t address, float amount) noexcept {
    const float before = densities_[address];
    const float after = amount < before ? before - amount : 0.0F;
    store(address, after);
    return before - after;
  }
  /// Gives a voxel of a brick above 0 a density from 0 to 1. Servo thread.
  void put(std::int32_t address, float density) noexcept { store(address, density); }

  /// Grows with every change in a brick; what is read after it is at least as new. Any thread.
  std::uint32_t version(std::int32_t brick) const noexcept {
    return versions_[static_cast<std::size_t>(brick)].load(std::memory_order_acquire);
  }

  /// The sum of all densities, added in order of address. Any thread.
  double amount() const noexcept;

  /// The volume as kernels on the servo thread see it: bricks by their place, x fastest, and
  /// densities by address.
  struct View {
    std::array<std::int32_t, 3> size;        // of the grid, in voxels
    std::array<std::int32_t, 3> table_size;  // of the table, in bricks
    const std::int32_t* table;               // brick numbers
    const float* densities;
    const std::uint64_t* filled;   // by brick and layer of z: bit x + 8 y of voxels with density
    const std::uint16_t* holding;  // by brick: how many of them
  };
  View view() const noexcept;

 private:
  void store(std::int32_t address, float density) noexcept {
    if ((densities_[address] > 0.0F) != (density > 0.0F)) {
      flip(address);
    }
    std::atomic_ref<float>(densities_[address]).store(density, std::memory_order_relaxed);
    auto& version = versions_[static_cast<std::size_t>(address / kBrickVoxels)];
    version.store(version.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
  void flip(std::int32_t address) noexcept {
    std::uint64_t& layer = filled_[static_cast<std::size_t>(address / 64)];
    const std::uint64_t bit = std::uint64_t{1} << (address % 64);
    layer ^= bit;
    auto& count = holding_[static_cast<std::size_t>(address / kBrickVoxels)];
    count = static_cast<std::uint16_t>((layer & bit) != 0 ? count + 1 : count - 1);
  }
  std::size_t table_index(const Voxel& voxel) const noexcept;
  void make_room();
  void keep_original(std::int32_t address, float density) noexcept {
    originals_[static_cast<std::size_t>(address)] =
        static_cast<std::uint8_t>(density * kOriginalSteps);
  }

  static constexpr float kOriginalSteps = 255.0F;

  geometry::VoxelGrid grid_;
  std::array<std::int32_t, 3> table_size_{};
  std::vector<std::int32_t> table_;                         // number of a brick; 0: none
  std::vector<Voxel> origins_;                              // by brick
  std::unique_ptr<float[]> densities_;                      // by address
  std::vector<std::uint8_t> labels_;                        // by address
  std::vector<std::uint8_t> originals_;                     // by address; empty: all 1
  std::vector<std::uint64_t> filled_;                       // by layer; the servo thread's
  std::vector<std::uint16_t> holding_;                      // by brick; likewise
  std::unique_ptr<std::atomic<std::uint32_t>[]> versions_;  // by brick
};

}  // namespace haptrial::bone
