#include "core/bone/drill/drill_kernel_internal.h"

namespace haptrial::bone::kernel {

std::int32_t touch_burr_baseline(const Cloud& cloud, const Placement& at, const Bricks& bricks,
                                 Hit* hits, std::int32_t room, Sums& sums) {
  return touch_burr(cloud, at, bricks, hits, room, sums);
}

}  // namespace haptrial::bone::kernel
