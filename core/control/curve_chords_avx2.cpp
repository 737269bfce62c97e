// The kernel of this file is compiled for AVX2; it runs where the processor has it.
#ifdef __x86_64__

// These headers come before the instructions are switched on, so that nothing shared is compiled
// with them.
#include <immintrin.h>

#include <cstring>

#include "core/control/curve_chords.h"

#pragma GCC push_options
#pragma GCC target("avx2")

namespace haptrial::control {
namespace {

constexpr std::size_t kLanes = 4;
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0
inline unsigned bits_of(Flags flags) {
  return static_cast<unsigned>(_mm256_movemask_pd((__m256d)flags));
}

}  // namespace
}  // namespace haptrial::control

#include "core/control/curve_chords_kernel.h"

namespace haptrial::control {

ChordKernel chord_kernel_avx2() { return {measure, scan}; }

}  // namespace haptrial::control

#pragma GCC pop_options

#endif
