// The kernel of this file is compiled for AVX2; it runs where the processor has it.
#ifdef __x86_64__

// These headers come before the instructions are switched on, so that nothing shared is compiled
// with them.
#include <immintrin.h>

#include <cstring>

#include "core/deformable/springs/force_kernel.h"

#pragma GCC push_options
#pragma GCC target("avx2,fma")

namespace haptrial::deformable {
namespace {

constexpr std::size_t kLanes = 4;
typedef double Lanes __attribute__((vector_size(8 * kLanes)));
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0

inline Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
  return (Lanes)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
}

/// Four rows to four columns and back.
inline void transpose(const __m256d* row, __m256d* column) {
  const __m256d xz01 = _mm256_unpacklo_pd(row[0], row[1]);
  const __m256d yw01 = _mm256_unpackhi_pd(row[0], row[1]);
  const __m256d xz23 = _mm256_unpacklo_pd(row[2], row[3]);
  const __m256d yw23 = _mm256_unpackhi_pd(row[2], row[3]);
  column[0] = _mm256_permute2f128_pd(xz01, xz23, 0x20);
  column[1] = _mm256_permute2f128_pd(yw01, yw23, 0x20);
  column[2] = _mm256_permute2f128_pd(xz01, xz23, 0x31);
  column[3] = _mm256_permute2f128_pd(yw01, yw23, 0x31);
}

inline void gather(const double* from, const std::int32_t* at, Lanes& x, Lanes& y, Lanes& z) {
  const __m256d row[4] = {_mm256_loadu_pd(from + at[0]), _mm256_loadu_pd(from + at[1]),
                          _mm256_loadu_pd(from + at[2]), _mm256_loadu_pd(from + at[3])};
  __m256d column[4];
  transpose(row, column);
  x = (Lanes)column[0];
  y = (Lanes)column[1];
  z = (Lanes)column[2];
}

inline void scatter(double* to, const std::int32_t* at, const Lanes& x, const Lanes& y,
                    const Lanes& z) {
  const __m256d row[4] = {(__m256d)x, (__m256d)y, (__m256d)z, _mm256_setzero_pd()};
  __m256d column[4];
  transpose(row, column);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    double* p = to + at[lane];
    _mm256_storeu_pd(p, _mm256_add_pd(_mm256_loadu_pd(p), column[lane]));
  }
}

}  // namespace
}  // namespace haptrial::deformable

#include "core/deformable/springs/force_kernel_lanes.h"

namespace haptrial::deformable {

std::size_t add_forces_avx2(const ForceQuery& query) noexcept { return add_forces(query); }

}  // namespace haptrial::deformable

#pragma GCC pop_options

#endif
