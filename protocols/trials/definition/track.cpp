#include "protocols/trials/definition/track.h"

#include <algorithm>
#include <cmath>

namespace haptrial::protocols {

double Track::applied(double asked) const noexcept {
  const double kept = std::clamp(asked, low, high);
  if (resolution <= 0.0) {
    return kept;
  }
  const double rounded = std::round(kept / resolution) * resolution;
  return rounded < low    ? std::ceil(low / resolution) * resolution
         : rounded > high ? std::floor(high / resolution) * resolution
                          : rounded;
}

}  // namespace haptrial::protocols
