#pragma once

#include "core/bone/drill/drill_kernel.h"

// The body of touch_burr_*(): plain loops over plain arrays, so that nothing of it is shared
// between instruction sets.
namespace haptrial::bone::kernel {
namespace {

constexpr std::int32_t kBlock = 512;  // samples a pass; sums of a pass fit 32 bits

/// Products and sums may leave 32 bits on the way to a result that does not: no overflow of a
/// signed number.
inline std::int32_t times(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}
inline std::int32_t plus(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Addresses of `count` samples from `first`; 0 to 511 where there is no brick.
inline void look_up(const Cloud& cloud, const Placement& at, const Bricks& bricks,
                    std::int32_t first, std::int32_t count, std::int32_t* address) {
  const std::int16_t* x = cloud.x + first;
  const std::int16_t* y = cloud.y + first;
  const std::int16_t* z = cloud.z + first;
  const std::int32_t* table = bricks.table;
  const std::int32_t ax = at.turn[0][0], ay = at.turn[0][1], az = at.turn[0][2];
  const std::int32_t bx = at.turn[1][0], by = at.turn[1][1], bz = at.turn[1][2];
  const std::int32_t cx = at.turn[2][0], cy = at.turn[2][1], cz = at.turn[2][2];
  const std::int32_t o0 = at.offset[0], o1 = at.offset[1], o2 = at.offset[2];
  const std::int32_t b0 = at.base[0], b1 = at.base[1], b2 = at.base[2];
  const std::uint32_t s0 = static_cast<std::uint32_t>(bricks.size[0]);
  const std::uint32_t s1 = static_cast<std::uint32_t>(bricks.size[1]);
  const std::uint32_t s2 = static_cast<std::uint32_t>(bricks.size[2]);
  const std::int32_t t0 = bricks.table_size[0], t1 = bricks.table_size[1];
  const std::int32_t shift = at.shift;
#pragma GCC ivdep
  for (std::int32_t s = 0; s < count; ++s) {
    const std::int32_t px = x[s], py = y[s], pz = z[s];
    const std::int32_t u = plus(plus(times(ax, px), times(ay, py)), plus(times(az, pz), o0));
    const std::int32_t v = plus(plus(times(bx, px), times(by, py)), plus(times(bz, pz), o1));
    const std::int32_t w = plus(plus(times(cx, px), times(cy, py)), plus(times(cz, pz), o2));
    const std::int32_t i = (u >> shift) + b0, j = (v >> shift) + b1, k = (w >> shift) + b2;
    const std::int32_t inside = -static_cast<std::int32_t>((static_cast<std::uint32_t>(i) < s0) &
                                                           (static_cast<std::uint32_t>(j) < s1) &
                                                           (static_cast<std::uint32_t>(k) < s2));
    const std::int32_t place = (i >> 3) + t0 * ((j >> 3) + t1 * (k >> 3));
    const std::int32_t brick = table[place & inside] & inside;
    address[s] = (brick << 9) + (i & 7) + ((j & 7) << 3) + ((k & 7) << 6);
  }
}

/// Sums of a block; immersed[s] receives 1 or 0.
inline void add_up(const Cloud& cloud, const float* densities, std::int32_t first,
                   std::int32_t count, const std::int32_t* address, std::int32_t* immersed,
                   Sums& sums) {
  std::int32_t n = 0, dx = 0, dy = 0, dz = 0, px = 0, py = 0, pz = 0;
#pragma GCC ivdep
  for (std::int32_t s = 0; s < count; ++s) {
    const std::int32_t in = densities[address[s]] > 0.0F ? -1 : 0;
    immersed[s] = -in;
    n -= in;
    dx += cloud.dx[first + s] & in;
    dy += cloud.dy[first + s] & in;
    dz += cloud.dz[first + s] & in;
    px += cloud.x[first + s] & in;
    py += cloud.y[first + s] & in;
    pz += cloud.z[first + s] & in;
  }
  sums.count += n;
  sums.direction[0] += dx;
  sums.direction[1] += dy;
  sums.direction[2] += dz;
  sums.position[0] += px;
  sums.position[1] += py;
  sums.position[2] += pz;
}

[[maybe_unused]] inline std::int32_t touch_burr(const Cloud& cloud, const Range& range,
                                                const Placement& at, const Bricks& bricks,
                                                Hit* hits, std::int32_t room, Sums& sums) {
  alignas(64) std::int32_t address[kBlock];
  alignas(64) std::int32_t immersed[kBlock];
  std::int32_t kept = 0;
  const std::int32_t end = range.first + range.count;
  for (std::int32_t first = range.first; first < end; first += kBlock) {
    const std::int32_t count = end - first < kBlock ? end - first : kBlock;
    look_up(cloud, at, bricks, first, count, address);
    const std::int64_t before = sums.count;
    add_up(cloud, bricks.densities, first, count, address, immersed, sums);
    const auto in_bone = static_cast<std::int32_t>(sums.count - before);
    if (in_bone == count && count <= room - kept) {
      for (std::int32_t s = 0; s < count; ++s) {
        hits[kept + s] = {address[s], first + s};
      }
      kept += count;
    } else if (in_bone > 0) {
      // The next place is always written, and kept only if the sample is immersed: no branch.
      for (std::int32_t s = 0; s < count && kept < room; ++s) {
        hits[kept] = {address[s], first + s};
        kept += immersed[s];
      }
    }
  }
  return kept;
}

}  // namespace
}  // namespace haptrial::bone::kernel
