#ifdef __x86_64__

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/geometry/bvh/search/bvh_kernel.h"

#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,fma,avx2,bmi,prefer-vector-width=512")

namespace haptrial::geometry::kernel {
namespace {

// The maskz forms: the plain ones warn in the headers of GCC 12.
struct Floats16 {
  using Number = __m512;
  static constexpr int kCount = 16;
  static constexpr __mmask16 kEvery = 0xffff;
  static Number all(float x) { return _mm512_set1_ps(x); }
  static Number load(const float* from) { return _mm512_load_ps(from); }
  static void store(float* to, Number x) { _mm512_store_ps(to, x); }
  static Number fma(Number a, Number b, Number c) { return _mm512_fmadd_ps(a, b, c); }
  static Number absolute(Number x) { return _mm512_abs_ps(x); }
  static Number root(Number x) { return _mm512_maskz_sqrt_ps(kEvery, x); }
  static Number smaller(Number a, Number b) { return _mm512_maskz_min_ps(kEvery, a, b); }
  static Number larger(Number a, Number b) { return _mm512_maskz_max_ps(kEvery, a, b); }
  static unsigned less(Number a, Number b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  static unsigned less_equal(Number a, Number b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
  static Number select(unsigned mask, Number yes, Number no) {
    return _mm512_mask_blend_ps(static_cast<__mmask16>(mask), no, yes);
  }
  static unsigned bits(unsigned mask) { return mask; }
  static float largest(Number x) {
    const __m256 half = _mm256_max_ps(_mm512_maskz_extractf32x8_ps(0xff, x, 0),
                                      _mm512_maskz_extractf32x8_ps(0xff, x, 1));
    __m128 quarter = _mm_max_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
    quarter = _mm_max_ps(quarter, _mm_movehl_ps(quarter, quarter));
    return _mm_cvtss_f32(_mm_max_ss(quarter, _mm_movehdup_ps(quarter)));
  }
  static float smallest(Number x) { return -largest(_mm512_set1_ps(0.0f) - x); }
};

struct Doubles8 {
  using Number = __m512d;
  static constexpr int kCount = 8;
  static Number all(double x) { return _mm512_set1_pd(x); }
  static Number load(const double* from) { return _mm512_load_pd(from); }
  static void store(double* to, Number x) { _mm512_store_pd(to, x); }
  static void store_floats(float* to, Number x) {
    _mm256_store_ps(to, _mm512_maskz_cvtpd_ps(0xff, x));
  }
  static Number root(Number x) { return _mm512_maskz_sqrt_pd(0xff, x); }
  static Number smaller(Number a, Number b) { return _mm512_maskz_min_pd(0xff, a, b); }
  static unsigned less(Number a, Number b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static Number select(unsigned mask, Number yes, Number no) {
    return _mm512_mask_blend_pd(static_cast<__mmask8>(mask), no, yes);
  }
};

}  // namespace
}  // namespace haptrial::geometry::kernel

#include "core/geometry/bvh/search/bvh_packet_search.h"

namespace haptrial::geometry::kernel {

const Kernels& avx512_kernels() {
  static const Kernels kernels = kernels_of<Floats16, Doubles8>();
  return kernels;
}

}  // namespace haptrial::geometry::kernel

#pragma GCC pop_options

#endif
