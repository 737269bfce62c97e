#include "core/subject/perceiver/upper_mean.h"

#include <algorithm>
#include <cmath>

namespace haptrial::subject {

void UpperMean::add(double value, double duration) noexcept {
  constexpr double kMost = 1000.0;
  value = std::clamp(value, 0.0, kMost);
  std::size_t bin = 0;
  if (value >= std::ldexp(1.0, kLowest)) {
    int exponent = 0;
    const double half = std::frexp(value, &exponent);  // value = half 2^exponent, half >= 1/2
    const int octave = exponent - 1 - kLowest;
    const int within = static_cast<int>((2.0 * half - 1.0) * kPerOctave);
    bin = 1 + static_cast<std::size_t>(octave * kPerOctave + within);
  }
  bins_[bin].time += duration;
  bins_[bin].sum += duration * value;
}

double UpperMean::mean() const noexcept {
  double whole = 0.0;
  for (const Bin& bin : bins_) {
    whole += bin.time;
  }
  double left = 0.5 * whole;
  double sum = 0.0;
  for (auto bin = bins_.rbegin(); bin != bins_.rend() && left > 0.0; ++bin) {
    if (bin->time > 0.0) {
      const double share = std::min(1.0, left / bin->time);
      sum += share * bin->sum;
      left -= share * bin->time;
    }
  }
  return whole > 0.0 ? sum / (0.5 * whole) : 0.0;
}

}  // namespace haptrial::subject
