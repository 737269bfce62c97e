// The kernel of this file is compiled for AVX2; it runs where the processor has it.
#ifdef __x86_64__

// These headers come before the instructions are switched on, so that nothing shared is compiled
// with them.
#include <algorithm>
#include <cstring>

#include "core/psychometric/procedure/information.h"

#pragma GCC push_options
#pragma GCC target("avx2")

namespace haptrial::psychometric {
namespace {

constexpr std::size_t kLanes = 8;

}  // namespace
}  // namespace haptrial::psychometric

#include "core/psychometric/procedure/information_kernel.h"

namespace haptrial::psychometric {

void row_sums_avx2(const float* rows, std::size_t count, std::size_t cells,
                   const GroupedWeights& weights, double* sums) {
  row_sums_of(rows, count, cells, weights, sums);
}

double row_sum_avx2(const double* row, std::size_t cells, const double* weights) {
  return row_sum_in_double(row, cells, weights);
}

}  // namespace haptrial::psychometric

#pragma GCC pop_options

#endif
