#pragma once

#include <algorithm>
#include <cstring>

#include "core/psychometric/quest/information.h"

// Included once for each instruction set, by a file that says how many numbers go side by side
// (kLanes): everything here is its own.
namespace haptrial::psychometric {
namespace {

typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef double Doubles __attribute__((vector_size(8 * kLanes)));
constexpr std::size_t kVectors = kColumns / kLanes;

inline Floats load(const float* from) {
  Floats lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

inline double row_sum_of(const float* row, std::size_t cells, const float* weights) {
  Doubles total[kVectors] = {};
  for (std::size_t begin = 0; begin < cells; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, cells);
    Floats part[kVectors] = {};
    for (std::size_t c = begin; c < end; c += kColumns) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        part[v] += load(row + c + v * kLanes) * load(weights + c + v * kLanes);
      }
    }
    for (std::size_t v = 0; v < kVectors; ++v) {
      total[v] += __builtin_convertvector(part[v], Doubles);
    }
  }
  double columns[kColumns];
  std::memcpy(columns, total, sizeof columns);
  for (std::size_t width = kColumns / 2; width > 0; width /= 2) {
    for (std::size_t i = 0; i < width; ++i) {
      columns[i] += columns[i + width];
    }
  }
  return columns[0];
}

inline void row_sums_of(const float* rows, std::size_t count, std::size_t cells,
                        const float* weights, double* sums) {
  for (std::size_t r = 0; r < count; ++r) {
    sums[r] = row_sum_of(rows + r * cells, cells, weights);
  }
}

}  // namespace
}  // namespace haptrial::psychometric
