#include "core/subject/perceiver/cue_combination.h"

#include <cmath>

namespace haptrial::subject {

double weight_of(const Cue& a, const Cue& b) noexcept {
  if (a.spread == b.spread) {
    return 0.5;
  }
  // The ratio alone counts, so that neither tiny nor infinite spreads overflow.
  const double ratio = a.spread / b.spread;
  return 1.0 / (1.0 + ratio * ratio);
}

Cue combine(const Cue& a, const Cue& b) noexcept {
  const double w = weight_of(a, b);
  Cue both;
  both.estimate = w == 0.0   ? b.estimate
                  : w == 1.0 ? a.estimate
                             : w * a.estimate + (1.0 - w) * b.estimate;
  // sigma^2 = w_a sigma_a^2; from the more reliable cue, whose spread is finite if any is.
  both.spread = a.spread <= b.spread ? std::sqrt(w) * a.spread : std::sqrt(1.0 - w) * b.spread;
  return both;
}

}  // namespace haptrial::subject
