#include "core/subject/force_memory.h"

#include <algorithm>

#include "core/subject/noise.h"

namespace haptrial::subject {

void ForceMemory::learn(const ForceProfile& exposure) noexcept {
  if (!known_) {
    profile_ = exposure;
    known_ = true;
    return;
  }
  for (int j = 0; j < ForceProfile::kKnots; ++j) {
    const double own = profile_.variance[j];
    const double total = own + exposure.variance[j];
    const double gain = total > 0.0 ? own / total : 0.5;  // two certain views count alike
    profile_.force[j] += gain * (exposure.force[j] - profile_.force[j]);
    profile_.variance[j] = (1.0 - gain) * own;
  }
}

void ForceMemory::drift(double drift, double correlation, RandomStream& random) noexcept {
  if (!known_ || !(drift > 0.0)) {
    return;
  }
  SmoothNoise noise(1.0 / ForceProfile::kKnots, correlation);
  noise.restart(random);
  for (int j = 0; j < ForceProfile::kKnots; ++j) {
    profile_.force[j] += drift * noise.next(random);
    profile_.variance[j] += drift * drift;
  }
}

double ForceMemory::at(double progress) const noexcept {
  if (!known_) {
    return 0.0;
  }
  // Knot j stands for the middle of its share of the pass.
  const double last = ForceProfile::kKnots - 1;
  const double u = std::clamp(progress * ForceProfile::kKnots - 0.5, 0.0, last);
  const int j = std::min(static_cast<int>(u), ForceProfile::kKnots - 2);
  const double t = u - j;
  return (1.0 - t) * profile_.force[j] + t * profile_.force[j + 1];
}

}  // namespace haptrial::subject
