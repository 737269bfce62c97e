#include "core/psychometric/quest/information.h"

namespace haptrial::psychometric {
namespace {

constexpr std::size_t kLanes = 4;

}  // namespace
}  // namespace haptrial::psychometric

#include "core/psychometric/quest/information_kernel.h"

namespace haptrial::psychometric {
namespace {

void row_sums_baseline(const float* rows, std::size_t count, std::size_t cells,
                       const float* weights, double* sums) {
  row_sums_of(rows, count, cells, weights, sums);
}

}  // namespace

RowSums* row_sums(InstructionSet set) {
  return choose(set, row_sums_baseline, HAPTRIAL_X86(row_sums_avx2), HAPTRIAL_X86(row_sums_avx512));
}

double row_sum(const double* row, std::size_t cells, const double* weights) noexcept {
  constexpr std::size_t kWide = 8;
  double sums[kWide] = {};
  std::size_t c = 0;
  for (; c + kWide <= cells; c += kWide) {
    for (std::size_t i = 0; i < kWide; ++i) {
      sums[i] += row[c + i] * weights[c + i];
    }
  }
  for (; c < cells; ++c) {
    sums[0] += row[c] * weights[c];
  }
  return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

}  // namespace haptrial::psychometric
