#include "core/sound/power_spectrum.h"

#include <gsl/gsl_fft_real.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptrial::sound {
namespace {

constexpr int kShortest = 16;  // samples in a segment

int fitting_segment(std::size_t samples, double rate) {
  constexpr double kLength = 0.04;  // [s]
  const auto wanted = std::bit_ceil(static_cast<std::size_t>(std::max(16.0, kLength * rate)));
  return static_cast<int>(std::min({wanted, std::bit_floor(samples), std::size_t{1} << 24}));
}

std::vector<double> hann(int size) {
  std::vector<double> window(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    window[static_cast<std::size_t>(i)] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / size);
  }
  return window;
}

/// The median of the bins around each bin: what a spectrum is without its lines.
std::vector<double> floor_of(const PowerSpectrum& spectrum) {
  constexpr double kReach = 150.0;  // [Hz]
  const auto size = static_cast<std::ptrdiff_t>(spectrum.power.size());
  const auto reach =
      std::max<std::ptrdiff_t>(16, static_cast<std::ptrdiff_t>(kReach / spectrum.bin));
  std::vector<double> floor(spectrum.power.size());
  std::vector<double> around;
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    const auto from = std::max<std::ptrdiff_t>(0, i - reach);
    const auto to = std::min(size, i + reach + 1);
    around.assign(spectrum.power.begin() + from, spectrum.power.begin() + to);
    const auto middle = around.begin() + (to - from) / 2;
    std::nth_element(around.begin(), middle, around.end());
    floor[static_cast<std::size_t>(i)] = *middle;
  }
  return floor;
}

/// Bins from `low` to `high`, both included.
struct Extent {
  std::size_t low;
  std::size_t high;
};

class Finder {
 public:
  explicit Finder(const PowerSpectrum& spectrum)
      : spectrum_(spectrum),
        power_(spectrum.power),
        floor_(floor_of(spectrum)),
        taken_(power_.size(), false) {}

  bool is_peak(std::size_t i, double above_floor) const {
    return i > 0 && i + 1 < power_.size() && power_[i] >= power_[i - 1] &&
           power_[i] > power_[i + 1] && power_[i] > above_floor * floor_[i];
  }
  bool taken(std::size_t i) const { return taken_[i]; }

  /// Takes the bins of a peak, so that they belong to no other.
  Peak take(std::size_t top) {
    const Extent extent{edge(top, -1), edge(top, 1)};
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t i = extent.low; i <= extent.high; ++i) {
      taken_[i] = true;
      const double above = std::max(0.0, power_[i] - floor_[i]);
      sum += above;
      moment += above * static_cast<double>(i);
    }
    return {spectrum_.bin * moment / sum, std::sqrt(2.0 * sum), bandwidth(top)};
  }

 private:
  /// The last bin of a peak on one side: where it meets the floor, or the valley to the next peak.
  std::size_t edge(std::size_t top, int side) const {
    constexpr int kWindow = 4;     // bins to which the window spreads a line
    constexpr double kRise = 2.0;  // over the lowest so far: another peak begins
    std::size_t lowest = top;
    std::size_t i = top;
    for (int steps = 1; i > 1 && i + 2 < power_.size(); ++steps) {
      i = side > 0 ? i + 1 : i - 1;
      if (taken_[i] || power_[i] > kRise * power_[lowest]) {
        break;
      }
      if (power_[i] < power_[lowest]) {
        lowest = i;
      }
      if (steps >= kWindow && power_[i] < 2.0 * floor_[i]) {
        return i;
      }
    }
    return lowest;
  }

  /// Place at which the power falls to half on one side, in bins from the top.
  double half(std::size_t top, int side) const {
    const double level = 0.5 * (power_[top] + floor_[top]);
    std::size_t i = top;
    while (i > 0 && i + 1 < power_.size() && power_[i] > level) {
      i = side > 0 ? i + 1 : i - 1;
    }
    const std::size_t before = side > 0 ? i - 1 : i + 1;
    const double fall = power_[before] - power_[i];
    const double beyond = fall > 0.0 ? (power_[before] - level) / fall : 0.0;
    return std::abs(static_cast<double>(before) - static_cast<double>(top)) + beyond;
  }

  double bandwidth(std::size_t top) const {
    constexpr double kHann = 1.44;  // bins at half the power
    const double seen = half(top, -1) + half(top, 1);
    // A Lorentzian of width w under a window of width g looks about w / 2 + sqrt(w² / 4 + g²) wide.
    return spectrum_.bin * std::max(0.0, seen - kHann * kHann / seen);
  }

  const PowerSpectrum& spectrum_;
  const std::vector<double>& power_;
  std::vector<double> floor_;
  std::vector<bool> taken_;
};

}  // namespace

PowerSpectrum power_spectrum(std::span<const float> signal, double rate, int segment) {
  if (segment == 0 && signal.size() >= kShortest) {
    segment = fitting_segment(signal.size(), rate);
  }
  if (!(rate > 0.0 && std::isfinite(rate)) || segment < kShortest ||
      !std::has_single_bit(static_cast<unsigned>(segment)) ||
      static_cast<std::size_t>(segment) > signal.size()) {
    throw std::invalid_argument(
        "power_spectrum: a segment must be a power of two from 16 to the signal's length");
  }
  const auto size = static_cast<std::size_t>(segment);
  const std::vector<double> window = hann(segment);
  double window_power = 0.0;
  for (const double w : window) {
    window_power += w * w;
  }
  PowerSpectrum result{rate, rate / segment, 0, std::vector<double>(size / 2 + 1, 0.0)};
  std::vector<double> values(size);
  for (std::size_t start = 0; start + size <= signal.size(); start += size / 2) {
    for (std::size_t i = 0; i < size; ++i) {
      values[i] = window[i] * static_cast<double>(signal[start + i]);
    }
    gsl_fft_real_radix2_transform(values.data(), 1, size);
    result.power[0] += values[0] * values[0];
    result.power[size / 2] += values[size / 2] * values[size / 2];
    for (std::size_t i = 1; i < size / 2; ++i) {
      result.power[i] += 2.0 * (values[i] * values[i] + values[size - i] * values[size - i]);
    }
    ++result.segments;
  }
  for (double& power : result.power) {
    power /= window_power * static_cast<double>(size) * result.segments;
  }
  return result;
}

Spectrum find_peaks(const PowerSpectrum& spectrum, const PeakSearch& search) {
  if (search.most < 1 || search.most > Spectrum::kMaxPeaks ||
      !(search.above_floor > 1.0 || search.above_floor == 0.0)) {
    throw std::invalid_argument("find_peaks: from 1 to 24 peaks, and above the floor");
  }
  const double above_floor = search.above_floor > 0.0
                                 ? search.above_floor
                                 : std::max(3.0, 1.0 + 12.0 / std::sqrt(spectrum.segments));
  Finder finder(spectrum);
  const auto first = static_cast<std::size_t>(std::ceil(search.lowest / spectrum.bin));
  std::vector<std::size_t> tops;
  double rest = 0.0;
  for (std::size_t i = first; i < spectrum.power.size(); ++i) {
    rest += spectrum.power[i];
    if (finder.is_peak(i, above_floor)) {
      tops.push_back(i);
    }
  }
  std::stable_sort(tops.begin(), tops.end(), [&](std::size_t a, std::size_t b) {
    return spectrum.power[a] > spectrum.power[b];
  });
  Spectrum found;
  for (const std::size_t top : tops) {
    if (found.count == search.most) {
      break;
    }
    if (!finder.taken(top)) {
      const Peak peak = finder.take(top);
      rest -= 0.5 * peak.amplitude * peak.amplitude;
      found.peaks[static_cast<std::size_t>(found.count++)] = peak;
    }
  }
  std::sort(found.peaks.begin(), found.peaks.begin() + found.count,
            [](const Peak& a, const Peak& b) { return a.frequency < b.frequency; });
  found.noise = std::sqrt(std::max(0.0, rest));
  return found;
}

double dominant(const Spectrum& spectrum) {
  Peak strongest;
  for (int i = 0; i < spectrum.count; ++i) {
    const Peak& peak = spectrum.peaks[static_cast<std::size_t>(i)];
    if (peak.amplitude > strongest.amplitude) {
      strongest = peak;
    }
  }
  return strongest.frequency;
}

double fundamental(const Spectrum& spectrum) {
  constexpr int kHighest = 8;         // harmonic that may be the strongest
  constexpr double kNear = 0.01;      // of a peak's frequency: it is a multiple
  constexpr double kNearlyAll = 0.9;  // of what the best one explains
  const double strongest = dominant(spectrum);
  std::array<double, kHighest> explained{};
  for (int n = 1; n <= kHighest && strongest > 0.0; ++n) {
    for (int i = 0; i < spectrum.count; ++i) {
      const Peak& peak = spectrum.peaks[static_cast<std::size_t>(i)];
      const double multiple = peak.frequency * n / strongest;
      const double whole = std::round(multiple);
      if (whole > 0.0 && std::abs(multiple - whole) < std::min(kNear * whole, 0.1)) {
        explained[static_cast<std::size_t>(n - 1)] += peak.amplitude;
      }
    }
  }
  const double most = *std::max_element(explained.begin(), explained.end());
  for (int n = 1; n <= kHighest; ++n) {
    if (explained[static_cast<std::size_t>(n - 1)] >= kNearlyAll * most) {
      return strongest / n;
    }
  }
  return strongest;
}

}  // namespace haptrial::sound
