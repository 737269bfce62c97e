#include <cmath>
#include <cstring>

#include "core/deformable/springs/force_kernel.h"

namespace haptrial::deformable {
namespace {

constexpr std::size_t kLanes = 2;
typedef double Lanes __attribute__((vector_size(8 * kLanes)));
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0

inline Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
  return Lanes{std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1])};
}

inline void gather(const double* from, const std::int32_t* at, Lanes& x, Lanes& y, Lanes& z) {
  const double* a = from + at[0];
  const double* b = from + at[1];
  x = Lanes{a[0], b[0]};
  y = Lanes{a[1], b[1]};
  z = Lanes{a[2], b[2]};
}

inline void scatter(double* to, const std::int32_t* at, const Lanes& x, const Lanes& y,
                    const Lanes& z) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    double* p = to + at[lane];
    p[0] += x[lane];
    p[1] += y[lane];
    p[2] += z[lane];
  }
}

}  // namespace
}  // namespace haptrial::deformable

#include "core/deformable/springs/force_kernel_lanes.h"

namespace haptrial::deformable {

std::size_t add_forces_baseline(const ForceQuery& query) noexcept { return add_forces(query); }

ForceKernel force_kernel(InstructionSet set) {
  return choose(set, add_forces_baseline, HAPTRIAL_X86(add_forces_avx2));
}

}  // namespace haptrial::deformable
