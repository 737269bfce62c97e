#include "analysis/psychophysics/fit/estimated.h"

#include <algorithm>
#include <cmath>

namespace haptrial::analysis::trials {

void remove_interval(Estimated& e) { e.low = e.high = kNotKnown; }

void widen(Estimated& e, double factor) {
  e.low = e.value - factor * (e.value - e.low);
  e.high = e.value + factor * (e.high - e.value);
}

void widen_log(Estimated& e, double factor) {
  const auto moved = [&](double end) {
    return e.value == 0.0 ? end : e.value * std::pow(end / e.value, factor);
  };
  e.low = moved(e.low);
  e.high = moved(e.high);
}

void widen_rate(Estimated& e, double factor, const RateBounds& bounds) {
  constexpr double kSame = 1e-6;
  if (bounds.high > bounds.low && e.value - bounds.low < kSame) {
    remove_interval(e);
    return;
  }
  widen(e, factor);
  e.low = std::isnan(e.low) ? e.low : std::max(e.low, bounds.low);
  e.high = std::isnan(e.high) ? e.high : std::min(e.high, bounds.high);
}

}  // namespace haptrial::analysis::trials
