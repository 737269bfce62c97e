#ifdef __x86_64__

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/geometry/bvh/bvh_kernel.h"

#pragma GCC push_options
#pragma GCC target("avx2,fma,bmi")

namespace haptrial::geometry::kernel {
namespace {

struct Floats8 {
  using Number = __m256;
  using Mask = __m256i;
  static constexpr int kCount = 8;
  static Number all(float x) { return _mm256_set1_ps(x); }
  static Number load(const float* from) { return _mm256_load_ps(from); }
  static void store(float* to, Number x) { _mm256_store_ps(to, x); }
  static Number fma(Number a, Number b, Number c) { return _mm256_fmadd_ps(a, b, c); }
  static Number absolute(Number x) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x); }
  static Number root(Number x) { return _mm256_sqrt_ps(x); }
  static Number smaller(Number a, Number b) { return _mm256_min_ps(a, b); }
  static Number larger(Number a, Number b) { return _mm256_max_ps(a, b); }
  static Mask less(Number a, Number b) {
    return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ));
  }
  static Mask less_equal(Number a, Number b) {
    return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
  }
  static Number select(Mask mask, Number yes, Number no) {
    return _mm256_blendv_ps(no, yes, _mm256_castsi256_ps(mask));
  }
  static unsigned bits(Mask mask) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(mask)));
  }
  static float largest(Number x) {
    __m128 half = _mm_max_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    half = _mm_max_ps(half, _mm_movehl_ps(half, half));
    return _mm_cvtss_f32(_mm_max_ss(half, _mm_movehdup_ps(half)));
  }
  static float smallest(Number x) { return -largest(_mm256_set1_ps(0.0f) - x); }
};

struct Doubles4 {
  using Number = __m256d;
  using Mask = __m256i;
  static constexpr int kCount = 4;
  static Number all(double x) { return _mm256_set1_pd(x); }
  static Number load(const double* from) { return _mm256_load_pd(from); }
  static void store(double* to, Number x) { _mm256_store_pd(to, x); }
  static void store_floats(float* to, Number x) { _mm_store_ps(to, _mm256_cvtpd_ps(x)); }
  static Number root(Number x) { return _mm256_sqrt_pd(x); }
  static Number smaller(Number a, Number b) { return _mm256_min_pd(a, b); }
  static Mask less(Number a, Number b) {
    return _mm256_castpd_si256(_mm256_cmp_pd(a, b, _CMP_LT_OQ));
  }
  static Number select(Mask mask, Number yes, Number no) {
    return _mm256_blendv_pd(no, yes, _mm256_castsi256_pd(mask));
  }
};

}  // namespace
}  // namespace haptrial::geometry::kernel

#include "core/geometry/bvh/bvh_packet_search.h"

namespace haptrial::geometry::kernel {

const Kernels& avx2_kernels() {
  static const Kernels kernels = kernels_of<Floats8, Doubles4>();
  return kernels;
}

}  // namespace haptrial::geometry::kernel

#pragma GCC pop_options

#endif
