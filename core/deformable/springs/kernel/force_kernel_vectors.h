#pragma once

#include <cstring>

#include "core/deformable/springs/kernel/force_kernel.h"

// Vectors of lanes; included by force_kernel_lanes.h, once for each instruction set.
namespace haptrial::deformable {
namespace {

#define HAPTRIAL_LANES inline __attribute__((always_inline))

typedef unsigned long long Bits __attribute__((vector_size(sizeof(Lanes))));

struct Vectors {
  Lanes x, y, z;
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
HAPTRIAL_LANES Lanes dot(const Vectors& a, const Vectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HAPTRIAL_LANES Vectors cross(const Vectors& a, const Vectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
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
HAPTRIAL_LANES Group<n> operator+(const Group<n>& a, const Group<n>& b) {
  return HAPTRIAL_EACH(a.part[i] + b.part[i]);
}
template <int n>
HAPTRIAL_LANES Group<n> operator*(const Group<n>& a, const Group<n>& b) {
  return HAPTRIAL_EACH(a.part[i] * b.part[i]);
}
template <int n>
HAPTRIAL_LANES Group<n> operator+(double a, const Group<n>& b) {
  return HAPTRIAL_EACH(a + b.part[i]);
}
template <int n>
HAPTRIAL_LANES Group<n> operator-(double a, const Group<n>& b) {
  return HAPTRIAL_EACH(a - b.part[i]);
}
template <int n>
HAPTRIAL_LANES Group<n> operator*(double a, const Group<n>& b) {
  return HAPTRIAL_EACH(a * b.part[i]);
}

/// 1 / √(2 x) to the rounding of doubles, by a first guess from the exponent's bits and three
/// steps: of Newton with constants that centre its error (8e-4 left), of third order (2e-9), of
/// Newton. No instruction whose result differs between processors. Large, but a number, where x is
/// 0: a collapsed edge has no direction.
template <int n>
HAPTRIAL_LANES Group<n> inverse_root_of_twice(const Group<n>& x) {
  Group<n> y = HAPTRIAL_EACH((Lanes)(0x5FE6EB50C7B537A9 - ((Bits)(x.part[i] + x.part[i]) >> 1)));
  y = y * (1.50087896 - x * y * y);
  Group<n> error = 0.5 - x * y * y;
  y = y + y * error * (1.0 + 1.5 * error);
  error = 0.5 - x * y * y;
  return y + y * error;
}

}  // namespace
}  // namespace haptrial::deformable
