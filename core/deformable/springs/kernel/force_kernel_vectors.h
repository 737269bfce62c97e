#pragma once

#include <cstring>

#include "core/deformable/springs/kernel/force_kernel.h"

// Vectors of lanes; included by force_kernel_lanes.h, once for each instruction set.
namespace haptrial::deformable {
namespace {

#define HAPTRIAL_LANES inline __attribute__((always_inline))

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

/// 1 / √x to the rounding of doubles, by a first guess from the exponent's bits and three steps: of
/// Newton with constants that centre its error (8e-4 left), of third order (2e-9), of Newton. No
/// instruction whose result differs between processors.
HAPTRIAL_LANES Lanes inverse_root(Lanes x) {
  const Lanes least = Lanes{} + 1e-100;  // a collapsed edge: its direction is 0, not its tension
  x = x > least ? x : least;
  Lanes y = (Lanes)(0x5FE6EB50C7B537A9 - ((Flags)x >> 1));
  y = y * (1.50087896 - (0.5 * x) * y * y);
  Lanes error = 1.0 - x * y * y;
  y = y + y * error * (0.5 + 0.375 * error);
  error = 1.0 - x * y * y;
  return y + (0.5 * y) * error;
}

}  // namespace
}  // namespace haptrial::deformable
