#pragma once

#include <algorithm>
#include <cstring>

#include "core/psychometric/procedure/information.h"

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

inline double row_sum_of(const float* row, const GroupedWeights& weights) {
  Doubles total[kVectors] = {};
  const std::size_t groups = weights.groups.size();
  for (std::size_t begin = 0; begin < groups; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, groups);
    Floats part[kVectors] = {};
    for (std::size_t g = begin; g < end; ++g) {
      const std::uint32_t c = weights.groups[g];
      for (std::size_t v = 0; v < kVectors; ++v) {
        part[v] += load(row + c + v * kLanes) * load(weights.values + c + v * kLanes);
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
                        const GroupedWeights& weights, double* sums) {
  for (std::size_t r = 0; r < count; ++r) {
    sums[r] = row_sum_of(rows + r * cells, weights);
  }
}

/// Eight sums side by side, in every instruction set.
inline double row_sum_in_double(const double* row, std::size_t cells, const double* weights) {
  constexpr std::size_t kWide = 8;
  typedef double Wide __attribute__((vector_size(8 * kWide)));
  Wide total = {};
  std::size_t c = 0;
  for (; c + kWide <= cells; c += kWide) {
    Wide likelihood, weight;
    std::memcpy(&likelihood, row + c, sizeof likelihood);
    std::memcpy(&weight, weights + c, sizeof weight);
    total += likelihood * weight;
  }
  double sums[kWide];
  std::memcpy(sums, &total, sizeof sums);
  for (; c < cells; ++c) {
    sums[0] += row[c] * weights[c];
  }
  return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

}  // namespace
}  // namespace haptrial::psychometric
