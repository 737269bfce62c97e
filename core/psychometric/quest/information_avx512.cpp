// The kernel of this file is compiled for AVX-512; it runs where the processor has it.
#ifdef __x86_64__

// Before the instructions are switched on, so that nothing shared is compiled with them.
#include <algorithm>
#include <cstring>

#include "core/psychometric/quest/information.h"

#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx2,prefer-vector-width=512")

namespace haptrial::psychometric {
namespace {

constexpr std::size_t kLanes = 16;

}  // namespace
}  // namespace haptrial::psychometric

#include "core/psychometric/quest/information_kernel.h"

namespace haptrial::psychometric {

void row_sums_avx512(const float* rows, std::size_t count, std::size_t cells,
                     const GroupedWeights& weights, double* sums) {
  row_sums_of(rows, count, cells, weights, sums);
}

double row_sum_avx512(const double* row, std::size_t cells, const double* weights) {
  return row_sum_in_double(row, cells, weights);
}

}  // namespace haptrial::psychometric

#pragma GCC pop_options

#endif
