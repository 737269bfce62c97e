// The kernel of this file is compiled for AVX-512; it runs where the processor has it.
#ifdef __x86_64__

// Before the instructions are switched on, so that nothing shared is compiled with them.
#include <immintrin.h>

#include <cstring>

#include "core/deformable/springs/kernel/force_kernel.h"

#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,prefer-vector-width=512")

namespace haptrial::deformable {
namespace {

constexpr std::size_t kLanes = 8;
typedef double Lanes __attribute__((vector_size(8 * kLanes)));
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0

inline Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
  return (Lanes)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
}

typedef double Four __attribute__((vector_size(32)));

inline Four four(const double* from) { return (Four)_mm256_loadu_pd(from); }

/// Two rows of four numbers, of lanes `low` and `high`.
inline Lanes two(const double* low, const double* high) {
  return __builtin_shufflevector(four(low), four(high), 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Every second pair of two vectors.
inline Lanes pairs(const Lanes& a, const Lanes& b, bool odd) {
  return odd ? __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
             : __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
}

inline Lanes unpack(const Lanes& a, const Lanes& b, bool odd) {
  return odd ? __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
             : __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
}

inline void gather(const double* from, const std::int32_t* at, Lanes& x, Lanes& y, Lanes& z) {
  const Lanes a = two(from + at[0], from + at[2]);
  const Lanes b = two(from + at[1], from + at[3]);
  const Lanes c = two(from + at[4], from + at[6]);
  const Lanes d = two(from + at[5], from + at[7]);
  const Lanes xz_low = unpack(a, b, false);  // x0 x1 z0 z1 x2 x3 z2 z3
  const Lanes xz_high = unpack(c, d, false);
  x = pairs(xz_low, xz_high, false);
  y = pairs(unpack(a, b, true), unpack(c, d, true), false);
  z = pairs(xz_low, xz_high, true);
}

inline void add_to(double* p, Four value) { _mm256_storeu_pd(p, (__m256d)(four(p) + value)); }

inline void add_two(double* low, double* high, const Lanes& value) {
  add_to(low, __builtin_shufflevector(value, value, 0, 1, 2, 3));
  add_to(high, __builtin_shufflevector(value, value, 4, 5, 6, 7));
}

inline void scatter(double* to, const std::int32_t* at, const Lanes& x, const Lanes& y,
                    const Lanes& z) {
  constexpr __mmask8 kThree = 0x77;        // no fourth number
  const Lanes even = unpack(x, y, false);  // x0 y0 x2 y2 ...
  const Lanes odd = unpack(x, y, true);    // x1 y1 x3 y3 ...
  const __m512i v02 = _mm512_setr_epi64(0, 1, 8, 8, 2, 3, 10, 10);
  const __m512i v46 = _mm512_setr_epi64(4, 5, 12, 12, 6, 7, 14, 14);
  const __m512i v13 = _mm512_setr_epi64(0, 1, 9, 9, 2, 3, 11, 11);
  const __m512i v57 = _mm512_setr_epi64(4, 5, 13, 13, 6, 7, 15, 15);
  const auto pick = [&](const Lanes& xy, __m512i which) __attribute__((always_inline)) {
    return (Lanes)_mm512_maskz_permutex2var_pd(kThree, (__m512d)xy, which, (__m512d)z);
  };
  add_two(to + at[0], to + at[2], pick(even, v02));
  add_two(to + at[4], to + at[6], pick(even, v46));
  add_two(to + at[1], to + at[3], pick(odd, v13));
  add_two(to + at[5], to + at[7], pick(odd, v57));
}

}  // namespace
}  // namespace haptrial::deformable

#include "core/deformable/springs/kernel/force_kernel_lanes.h"

namespace haptrial::deformable {

std::size_t add_forces_avx512(const ForceQuery& query) noexcept { return add_forces(query); }

}  // namespace haptrial::deformable

#pragma GCC pop_options

#endif
