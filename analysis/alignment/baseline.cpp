#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cmath>
#include <limits>

#include "analysis/alignment/kernel.h"

#pragma GCC push_options
#pragma GCC optimize("no-tree-slp-vectorize")  // it gathers the mask stores, at a loss

#include "analysis/alignment/sweep.h"

namespace haptrial::analysis::kernel {
namespace {

/// Four floats in the compiler's own vector type, which every target has.
struct Lanes4 {
  typedef float Number __attribute__((vector_size(16)));
  typedef std::int32_t Mask __attribute__((vector_size(16)));
  static constexpr std::size_t kCount = 4;
  static Number all(float x) { return Number{x, x, x, x}; }
  static Number load(const float* from) {
    Number x;
    std::memcpy(&x, from, sizeof x);
    return x;
  }
  static void store(float* to, Number x) { std::memcpy(to, &x, sizeof x); }
  static Number absolute(Number x) { return (Number)((Mask)x & 0x7fffffff); }
  static Number smaller(Number a, Number b) {
#ifdef __SSE2__
    return _mm_min_ps(a, b);
#else
    return a < b ? a : b;
#endif
  }
  static std::uint16_t less(Number a, Number b) {
    const Mask mask = a < b;
#ifdef __SSE2__
    return static_cast<std::uint16_t>(_mm_movemask_ps((__m128)mask));
#else
    return static_cast<std::uint16_t>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) |
                                      (mask[3] & 8));
#endif
  }
  /// Lanes 1 to 3 of x, then lane 0 of `last`.
  static Number shift_in(Number x, Number last) {
    return __builtin_shufflevector(x, last, 1, 2, 3, 4);
  }
};

}  // namespace

const Kernels& baseline_kernels() {
  static const Kernels kernels = kernels_of<Lanes4, 4, 4>();
  return kernels;
}

}  // namespace haptrial::analysis::kernel

#pragma GCC pop_options
