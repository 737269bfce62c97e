#include "tests/experiments/frame_periods.h"

#include <algorithm>
#include <cmath>

namespace haptrial::test {

double unaccounted_periods(const std::vector<record::FrameRow>& frames, double rate) {
  constexpr std::size_t kSteady = 10;
  constexpr std::size_t kTried = 10;  // at either end
  double least = 1e9;
  for (std::size_t first = kSteady; first < kSteady + kTried; ++first) {
    double periods = 0.0;
    for (std::size_t last = first + 1; last < frames.size(); ++last) {
      periods += 1 + frames[last].dropped;
      const auto span = static_cast<double>(frames[last].time_ns - frames[first].time_ns);
      if (last + kTried >= frames.size()) {
        least = std::min(least, std::abs(periods - 1e-9 * span * rate));
      }
    }
  }
  return least;
}

}  // namespace haptrial::test
