#pragma once

// Between alignment.cpp and the kernels that fill the direction bits, one file per instruction set.

#include <cstddef>
#include <cstdint>

#include "analysis/alignment_isa.h"

namespace haptrial::analysis::kernel {

/// How the cheapest way into each of `lanes` cells came, one bit a cell: straight from (i-1,j-1)
/// where `aside` is 0, else from (i,j-1) where `left` is 1, else from (i-1,j).
struct Directions {
  std::uint16_t aside;
  std::uint16_t left;
};

/// One pair, swept in strips of `strip_rows` target samples. Within a strip a vector holds `lanes`
/// consecutive rows on one anti-diagonal, the lowest row in lane 0. Values are scaled (alignment_
/// error.h). Arrays may be read `strip_rows` places before and after the columns given.
struct SingleTask {
  const float* target_force;   // (strips * strip_rows); lowest row of each vector first
  const float* target_slope;   // likewise
  const float* applied_force;  // (columns); infinite before column 0, finite after the last
  const float* applied_slope;  // likewise
  float* boundary;             // (columns); D of the row above the strip; 0 at -1, else infinite
  Directions* directions;      // (strips x (columns + strip_rows - 1) x vectors)
  std::size_t strips;
  std::size_t columns;
  float penalty;
};

/// `lanes` pairs side by side, swept in tiles of `tile_rows` target samples.
struct BatchTask {
  const float* target_force;   // (tiles * tile_rows x lanes)
  const float* target_slope;   // likewise
  const float* applied_force;  // (columns x lanes)
  const float* applied_slope;  // likewise
  float* boundary;             // (columns x lanes); D of the row above the tile; infinite
  Directions* directions;      // (tiles x columns x tile_rows)
  std::size_t tiles;
  std::size_t columns;
  float penalty;
};

struct Kernels {
  std::size_t lanes;       // of one vector
  std::size_t strip_rows;  // of a strip of the single kernel: a multiple of lanes
  std::size_t tile_rows;   // of a tile of the batch kernel
  void (*fill_single[2])(const SingleTask&);  // for p = 1 and p = 2
  void (*fill_batch[2])(const BatchTask&);
};

/// The last two exist where the compiler targets x86-64; kernels_for() knows what the machine runs.
const Kernels& baseline_kernels();
const Kernels& avx2_kernels();
const Kernels& avx512_kernels();

/// @throws std::invalid_argument when this machine cannot run `set`.
const Kernels& kernels_for(InstructionSet set);

}  // namespace haptrial::analysis::kernel
