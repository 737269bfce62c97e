#pragma once

// Interface between alignment.cpp and the kernels that fill the direction bits, one file per
// instruction set.

#include <cstddef>
#include <cstdint>

#include "analysis/alignment/isa.h"

namespace haptrial::analysis::kernel {

/// How the cheapest way into each of `lanes` cells came, one bit a cell: straight from (i-1,j-1)
/// where `aside` is 0, else from (i,j-1) where `left` is 1, else from (i-1,j).
struct Directions {
  std::uint16_t aside;
  std::uint16_t left;
};

/// A sweep over strips of target samples, each of a few vectors of rows. One pair: a vector holds
/// `lanes` consecutive rows, the lowest in lane 0, and `stride` is 1. A batch: a vector holds one
/// row of `lanes` pairs, and `stride` is `lanes`. Values are scaled (error.h).
///
/// The arrays over columns may be read, and the boundary written, for as many columns before the
/// first and after the last as a strip has rows.
struct Task {
  const float* target_force;   // (strips x vectors x lanes)
  const float* target_slope;   // likewise
  const float* applied_force;  // (columns x stride); infinite before them, finite after
  const float* applied_slope;  // likewise
  float* boundary;             // (columns x stride); D above row 0, infinite but at column -1
  Directions* directions;      // (strips x (columns + rows of a strip - 1) x vectors)
  std::size_t strips;
  std::size_t columns;
  float penalty;
};

/// Powers of two throughout. Sweeps by the weight of a straight step's error, 1 or 2, then by p, 1
/// or 2.
struct Kernels {
  std::size_t lanes;           // of one vector
  std::size_t single_vectors;  // of a strip of one pair, each of `lanes` rows
  std::size_t batch_vectors;   // of a strip of a batch, each of one row
  void (*sweep_single[2][2])(const Task&);
  void (*sweep_batch[2][2])(const Task&);

  /// |x|^p in place, to 3e-13 of it where |x|^p is below 2^200 and p at most 100.
  void (*raise)(double* values, std::size_t count, double power);
};

/// The last two exist where the compiler targets x86-64; kernels_for() knows what the machine runs.
const Kernels& baseline_kernels();
const Kernels& avx2_kernels();
const Kernels& avx512_kernels();

/// @throws std::invalid_argument when this machine cannot run `set`.
const Kernels& kernels_for(InstructionSet set);

}  // namespace haptrial::analysis::kernel
