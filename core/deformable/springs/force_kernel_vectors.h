#pragma once

#include <cstring>

#include "core/deformable/springs/force_kernel.h"

// Vectors of lanes; included by force_kernel_lanes.h, once for each instruction set.
namespace haptrial::deformable {
namespace {

#define HAPTRIAL_LANES inline __attribute__((always_inline))

typedef unsigned long long Bits __attribute__((vector_size(sizeof(Lanes))));

struct Vectors {
  Lanes x, y, z;

  // Number by number, as GCC would copy the whole through memory.
  HAPTRIAL_LANES Vectors& operator=(const Vectors& from) {
    x = from.x;
    y = from.y;
    z = from.z;
    return *this;
  }
};

HAPTRIAL_LANES Vectors operator-(const Vectors& a, const Vectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HAPTRIAL_LANES Vectors operator+(const Vectors& a, const Vectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HAPTRIAL_LANES Vectors operator*(const Lanes& s, const Vectors& a) {
  return {s * a.x, s * a.y, s * a.z};
}
HAPTRIAL_LANES Vectors fused(const Lanes& s, const Vectors& a, const Vectors& b) {
  return {fused(s, a.x, b.x), fused(s, a.y, b.y), fused(s, a.z, b.z)};
}
HAPTRIAL_LANES Lanes dot(const Vectors& a, const Vectors& b) {
  return fused(a.z, b.z, fused(a.y, b.y, a.x * b.x));
}
/// a b - c d, the first product before it is rounded.
HAPTRIAL_LANES Lanes minor(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  return fused(a, b, -(c * d));
}
HAPTRIAL_LANES Vectors cross(const Vectors& a, const Vectors& b) {
  return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}
HAPTRIAL_LANES Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// Numbers that take the same steps side by side, so that none waits for its own last step.
template <int n>
struct Group {
  Lanes part[n];
};

template <int n, class Call>
HAPTRIAL_LANES Group<n> each(const Call& call) {
  Group<n> group;
#pragma GCC unroll 8
  for (int i = 0; i < n; ++i) {
    group.part[i] = call(i);
  }
  return group;
}

#define HAPTRIAL_EACH(expression) \
  each<n>([&](int i) __attribute__((always_inline)) { return expression; })
template <int n>
HAPTRIAL_LANES Group<n> operator*(const Group<n>& a, const Group<n>& b) {
  return HAPTRIAL_EACH(a.part[i] * b.part[i]);
}
template <int n>
HAPTRIAL_LANES Group<n> operator-(const Group<n>& a) {
  return HAPTRIAL_EACH(-a.part[i]);
}
template <int n>
HAPTRIAL_LANES Group<n> fused(const Group<n>& a, const Group<n>& b, const Group<n>& c) {
  return HAPTRIAL_EACH(fused(a.part[i], b.part[i], c.part[i]));
}
template <int n>
HAPTRIAL_LANES Group<n> same(double value) {
  return each<n>([&](int) __attribute__((always_inline)) { return Lanes{} + value; });
}

/// 1 / √(2 x) to 5e-16, from the exponent's bits by two steps: of Newton with constants that centre
/// its error (9e-4 left), and of fifth order, whose error is spread evenly over what is left. No
/// instruction whose result differs between processors. Large, but a number, where x is 0: a
/// collapsed edge has no direction.
template <int n>
HAPTRIAL_LANES Group<n> inverse_root_of_twice(const Group<n>& x) {
  Group<n> y = HAPTRIAL_EACH((Lanes)(0x5FDEEB50C7B537A9 - ((Bits)x.part[i] >> 1)));
  y = y * fused(-(x * y), y, same<n>(1.50089));
  const Group<n> error = fused(-(x * y), y, same<n>(0.5));
  // (1 - 2 e)^(-1/2) - 1 over e, by Chebyshev's polynomials to |e| = 9e-4.
  Group<n> more = fused(same<n>(4.375), error, same<n>(2.50000797));
  more = fused(more, error, same<n>(1.5));
  more = fused(more, error, same<n>(0.9999999999983854));
  return fused(y * error, more, y);
}

}  // namespace
}  // namespace haptrial::deformable
