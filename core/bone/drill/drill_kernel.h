#pragma once

#include <cstdint>

// The inner loop of Drill::touch(), compiled once for each instruction set. Integers only, so that
// the same bits come out of all of them.
namespace haptrial::bone::kernel {

/// Pose of a burr in a grid, in fixed point: a sample at (x, y, z) of Burr::Arrays lies in voxel
/// base + floor((turn (x, y, z) + offset) / 2^shift).
struct Placement {
  std::int32_t turn[3][3];
  std::int32_t offset[3];
  std::int32_t base[3];
  std::int32_t shift;
};

/// BoneVolume::View without its types.
struct Bricks {
  std::int32_t size[3];        // of the grid, in voxels
  std::int32_t table_size[2];  // of the table along x and y, in bricks
  const std::int32_t* table;
  const float* densities;
};

/// The samples' arrays (Burr::Arrays).
struct Cloud {
  const std::int16_t* x;
  const std::int16_t* y;
  const std::int16_t* z;
  const std::int16_t* dx;
  const std::int16_t* dy;
  const std::int16_t* dz;
  std::int32_t count;
};

/// A sample that lies in bone.
struct Hit {
  std::int32_t address;
  std::int32_t sample;
};

/// Sums over the samples that lie in bone.
struct Sums {
  std::int64_t count;
  std::int64_t direction[3];
  std::int64_t position[3];
};

/// Samples of a cloud, one after the other.
struct Range {
  std::int32_t first;
  std::int32_t count;
};

/// @param hits  room for `room` of them; the first ones are kept, in order of sample
/// @param sums  receives those of the range on top of what it has
/// @returns how many were kept
using TouchBurr = std::int32_t (*)(const Cloud&, const Range&, const Placement&, const Bricks&,
                                   Hit* hits, std::int32_t room, Sums& sums);
/// Finds the voxels in which samples lie. @param range  at most kMostFound @param address  theirs,
/// in order
using FindBurr = void (*)(const Cloud&, const Range&, const Placement&, const Bricks&,
                          std::int32_t* address);
constexpr std::int32_t kMostFound = 64;

std::int32_t touch_burr_baseline(const Cloud&, const Range&, const Placement&, const Bricks&, Hit*,
                                 std::int32_t, Sums&);
void find_burr_baseline(const Cloud&, const Range&, const Placement&, const Bricks&, std::int32_t*);
/// These exist where the compiler targets x86-64.
std::int32_t touch_burr_avx2(const Cloud&, const Range&, const Placement&, const Bricks&, Hit*,
                             std::int32_t, Sums&);
void find_burr_avx2(const Cloud&, const Range&, const Placement&, const Bricks&, std::int32_t*);

}  // namespace haptrial::bone::kernel
