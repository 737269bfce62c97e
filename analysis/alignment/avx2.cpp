#ifdef __x86_64__

#include <immintrin.h>

#include <cmath>
#include <limits>

#include "analysis/alignment/kernel.h"

#pragma GCC push_options
#pragma GCC target("avx2")
#pragma GCC optimize("no-tree-slp-vectorize")  // it gathers the mask stores, at a loss

namespace haptrial::analysis::kernel {
namespace {

struct Lanes8 {
  using Number = __m256;
  static constexpr std::size_t kCount = 8;
  static Number all(float x) { return _mm256_set1_ps(x); }
  static Number load(const float* from) { return _mm256_loadu_ps(from); }
  static void store(float* to, Number x) { _mm256_storeu_ps(to, x); }
  static Number absolute(Number x) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x); }
  static Number smaller(Number a, Number b) { return _mm256_min_ps(a, b); }
  static std::uint16_t less(Number a, Number b) {
    return static_cast<std::uint16_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
  }
  /// Lanes 1 to 7 of x, then lane 0 of `last`.
  static Number shift_in(Number x, Number last) {
    const __m256 joint = _mm256_permute2f128_ps(x, last, 0x21);
    return _mm256_castsi256_ps(
        _mm256_alignr_epi8(_mm256_castps_si256(joint), _mm256_castps_si256(x), 4));
  }
};

}  // namespace
}  // namespace haptrial::analysis::kernel

#include "analysis/alignment/sweep.h"

namespace haptrial::analysis::kernel {

const Kernels& avx2_kernels() {
  static const Kernels kernels = kernels_of<Lanes8, 8, 4>();
  return kernels;
}

}  // namespace haptrial::analysis::kernel

#pragma GCC pop_options

#endif
