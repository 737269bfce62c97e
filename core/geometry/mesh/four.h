#pragma once

// Four floats in the compiler's own vector type: x, y, z and one more.

#include <cmath>
#include <cstdint>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace haptrial::geometry {

typedef float Four __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

inline Four smaller(Four a, Four b) {
#ifdef __SSE__
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Four larger(Four a, Four b) {
#ifdef __SSE__
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Four root(Four a) {
#ifdef __SSE__
  return _mm_sqrt_ps(a);
#else
  return Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}

/// A bit for each of the four that a condition holds for.
inline unsigned bits(FourInts holds) {
#ifdef __SSE__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(holds)));
#else
  return (holds[0] & 1u) | (holds[1] & 2u) | (holds[2] & 4u) | (holds[3] & 8u);
#endif
}

inline Four all_four(float x) { return Four{x, x, x, x}; }

/// A box, or the hull of what has been added to it.
struct FourBox {
  Four low = all_four(3e38f);
  Four high = all_four(-3e38f);

  void add(const FourBox& other) {
    low = smaller(low, other.low);
    high = larger(high, other.high);
  }
  void add(Four point) {
    low = smaller(low, point);
    high = larger(high, point);
  }
  /// Half of its surface.
  float half_area() const {
    const Four side = high - low;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }
};

}  // namespace haptrial::geometry
