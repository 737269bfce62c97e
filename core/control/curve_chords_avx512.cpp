// The kernel of this file is compiled for AVX-512; it runs where the processor has it.
#ifdef __x86_64__

// Before the instructions are switched on, so that nothing shared is compiled with them.
#include <immintrin.h>

#include <cstring>

#include "core/control/curve_chords.h"

#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx2,prefer-vector-width=512")

namespace haptrial::control {
namespace {

constexpr std::size_t kLanes = 8;
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0
inline unsigned bits_of(Flags flags) { return _mm512_movepi64_mask((__m512i)flags); }

}  // namespace
}  // namespace haptrial::control

#include "core/control/curve_chords_kernel.h"

namespace haptrial::control {

ChordKernel chord_kernel_avx512() { return {measure, scan}; }

}  // namespace haptrial::control

#pragma GCC pop_options

#endif
