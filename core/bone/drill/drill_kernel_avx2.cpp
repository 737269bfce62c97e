// The kernel of this file is compiled for AVX2; it runs where the processor has it.
#ifdef __x86_64__

// These headers come before the instructions are switched on, so that nothing shared is compiled
// with them.
#include <cstdint>

#pragma GCC push_options
#pragma GCC target("avx2")

#include "core/bone/drill/drill_kernel_internal.h"

namespace haptrial::bone::kernel {

std::int32_t touch_burr_avx2(const Cloud& cloud, const Range& range, const Placement& at,
                             const Bricks& bricks, Hit* hits, std::int32_t room, Sums& sums) {
  return touch_burr(cloud, range, at, bricks, hits, room, sums);
}

void find_burr_avx2(const Cloud& cloud, const Range& range, const Placement& at,
                    const Bricks& bricks, std::int32_t* address) {
  look_up(cloud, at, bricks, range.first, range.count, address);
}

}  // namespace haptrial::bone::kernel

#pragma GCC pop_options

#endif
