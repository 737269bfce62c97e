#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/geometry/bvh/bvh_kernel.h"
#include "core/geometry/bvh/bvh_packet_search.h"
#include "core/geometry/mesh/four.h"

namespace haptrial::geometry::kernel {
namespace {

/// Four floats in the compiler's own vector type, which every target has.
struct Floats4 {
  using Number = Four;
  using Mask = FourInts;
  static constexpr int kCount = 4;
  static Number all(float x) { return all_four(x); }
  static Number load(const float* from) {
    Number x;
    std::memcpy(&x, from, sizeof x);
    return x;
  }
  static void store(float* to, Number x) { std::memcpy(to, &x, sizeof x); }
  static Number fma(Number a, Number b, Number c) { return a * b + c; }
  static Number absolute(Number x) {
    return std::bit_cast<Number>(std::bit_cast<Mask>(x) & 0x7fffffff);
  }
  static Number root(Number x) {
    return Number{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
  }
  static Number smaller(Number a, Number b) { return geometry::smaller(a, b); }
  static Number larger(Number a, Number b) { return geometry::larger(a, b); }
  static Mask less(Number a, Number b) { return a < b; }
  static Mask less_equal(Number a, Number b) { return a <= b; }
  static Number select(Mask mask, Number yes, Number no) {
    return std::bit_cast<Number>((std::bit_cast<Mask>(yes) & mask) |
                                 (std::bit_cast<Mask>(no) & ~mask));
  }
  static unsigned bits(Mask mask) {
#ifdef __SSE__
    return static_cast<unsigned>(_mm_movemask_ps(std::bit_cast<__m128>(mask)));
#else
    return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
  }
  static float largest(Number x) { return std::max({x[0], x[1], x[2], x[3]}); }
  static float smallest(Number x) { return std::min({x[0], x[1], x[2], x[3]}); }
};

struct Doubles2 {
  typedef double Number __attribute__((vector_size(16)));
  typedef std::int64_t Mask __attribute__((vector_size(16)));
  static constexpr int kCount = 2;
  static Number all(double x) { return Number{x, x}; }
  static Number load(const double* from) {
    Number x;
    std::memcpy(&x, from, sizeof x);
    return x;
  }
  static void store(double* to, Number x) { std::memcpy(to, &x, sizeof x); }
  static void store_floats(float* to, Number x) {
    to[0] = static_cast<float>(x[0]);
    to[1] = static_cast<float>(x[1]);
  }
  static Number root(Number x) { return Number{std::sqrt(x[0]), std::sqrt(x[1])}; }
  static Number smaller(Number a, Number b) { return select(a < b, a, b); }
  static Mask less(Number a, Number b) { return a < b; }
  static Number select(Mask mask, Number yes, Number no) {
    return std::bit_cast<Number>((std::bit_cast<Mask>(yes) & mask) |
                                 (std::bit_cast<Mask>(no) & ~mask));
  }
};

}  // namespace

const Kernels& baseline_kernels() {
  static const Kernels kernels = kernels_of<Floats4, Doubles2>();
  return kernels;
}

}  // namespace haptrial::geometry::kernel
