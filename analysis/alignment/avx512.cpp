#ifdef __x86_64__

#include <immintrin.h>

#include <cmath>
#include <limits>

#include "analysis/alignment/kernel.h"

#pragma GCC push_options
#pragma GCC target("avx512f")
#pragma GCC optimize("no-tree-slp-vectorize")  // it gathers the mask stores, at a loss

namespace haptrial::analysis::kernel {
namespace {

struct Lanes16 {
  using Number = __m512;
  static constexpr std::size_t kCount = 16;
  static constexpr __mmask16 kEveryLane = 0xffff;  // the plain forms warn in GCC 12 headers
  static Number all(float x) { return _mm512_set1_ps(x); }
  static Number load(const float* from) { return _mm512_loadu_ps(from); }
  static void store(float* to, Number x) { _mm512_storeu_ps(to, x); }
  static Number absolute(Number x) { return _mm512_abs_ps(x); }
  static Number smaller(Number a, Number b) { return _mm512_maskz_min_ps(kEveryLane, a, b); }
  static std::uint16_t less(Number a, Number b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  /// Lanes 1 to 15 of x, then lane 0 of `last`.
  static Number shift_in(Number x, Number last) {
    return _mm512_castsi512_ps(_mm512_maskz_alignr_epi32(kEveryLane, _mm512_castps_si512(last),
                                                         _mm512_castps_si512(x), 1));
  }
};

}  // namespace
}  // namespace haptrial::analysis::kernel

#include "analysis/alignment/sweep.h"

namespace haptrial::analysis::kernel {

const Kernels& avx512_kernels() {
  static const Kernels kernels = kernels_of<Lanes16, 8, 8>();
  return kernels;
}

}  // namespace haptrial::analysis::kernel

#pragma GCC pop_options

#endif
