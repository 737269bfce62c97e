#include "core/bone/drill/drill_kernel_internal.h"

namespace haptrial::bone::kernel {

std::int32_t touch_burr_baseline(const Cloud& cloud, const Range& range, const Placement& at,
                                 const Bricks& bricks, Hit* hits, std::int32_t room, Sums& sums) {
  return touch_burr(cloud, range, at, bricks, hits, room, sums);
}

void find_burr_baseline(const Cloud& cloud, const Range& range, const Placement& at,
                        const Bricks& bricks, std::int32_t* address) {
  look_up(cloud, at, bricks, range.first, range.count, address);
}

}  // namespace haptrial::bone::kernel
