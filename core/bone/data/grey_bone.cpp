#include "core/bone/data/grey_bone.h"

#include <algorithm>
#include <cmath>

namespace haptrial::bone {
GreyHistogram::GreyHistogram(std::span<const float> values) {
  const auto [least, most] = std::ranges::minmax(values);
  low = least;
  width = std::max((static_cast<double>(most) - low) / kBins, 1e-12);
  for (const float value : values) {
    const auto bin = static_cast<std::size_t>((value - low) / width);
    counts[std::min(bin, kBins - 1)] += 1.0;
  }
}

float density_of(double value, const GreyLevels& levels) {
  if (value < levels.threshold) {
    return 0.0F;
  }
  const double share = (value - levels.threshold) / (levels.dense - levels.threshold);
  const double density = 0.2 + 0.8 * std::clamp(share, 0.0, 1.0);
  return static_cast<float>(std::round(255.0 * density) / 255.0);
}

double find_threshold(std::span<const float> values) {
  return find_threshold(GreyHistogram(values));
}

double find_threshold(const GreyHistogram& histogram) {
  constexpr std::size_t kBins = GreyHistogram::kBins;
  std::array<double, kBins + 1> weight{};
  std::array<double, kBins + 1> moment{};
  for (std::size_t i = 0; i < kBins; ++i) {
    weight[i + 1] = weight[i] + histogram.counts[i];
    moment[i + 1] = moment[i] + histogram.counts[i] * static_cast<double>(i);
  }
  const auto part = [&](std::size_t from, std::size_t to) {
    const double w = weight[to] - weight[from];
    const double m = moment[to] - moment[from];
    return w > 0.0 ? m * m / w : 0.0;
  };
  double best = -1.0;
  std::size_t upper = kBins / 2;
  for (std::size_t a = 1; a + 1 < kBins; ++a) {
    for (std::size_t b = a + 1; b < kBins; ++b) {
      const double between = part(0, a) + part(a, b) + part(b, kBins);
      if (between > best) {
        best = between;
        upper = b;
      }
    }
  }
  return histogram.value_of(static_cast<double>(upper));
}

double quantile_from(std::span<const float> values, double low, double share) {
  std::vector<float> chosen;
  for (const float value : values) {
    if (value >= low) {
      chosen.push_back(value);
    }
  }
  if (chosen.empty()) {
    return low;
  }
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(chosen.size() - 1));
  std::ranges::nth_element(chosen, chosen.begin() + place);
  return chosen[static_cast<std::size_t>(place)];
}

}  // namespace haptrial::bone
