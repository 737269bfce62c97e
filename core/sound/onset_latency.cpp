#include "core/sound/onset_latency.h"

#include <algorithm>
#include <cmath>

namespace haptrial::sound {
namespace {

constexpr double kApart = 0.05;    // of two pulses at least [s]
constexpr double kClear = 8.0;     // times the noise, which a pulse is above
constexpr double kBefore = 0.005;  // a sound may seem to begin before its pulse [s]
constexpr double kAfter = 0.5;     // [s]
constexpr double kCompared = 0.1;  // of the sound at most [s]
constexpr double kSilence = 0.02;  // before it, which is part of what is compared [s]
constexpr double kLeastFit = 0.25;

double median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The first samples of pulses.
std::vector<long> begins_of(std::span<const float> channel, double rate) {
  std::vector<float> swing(channel.begin(), channel.end());
  const double rest = median_of(swing);
  double largest = 0.0;
  for (float& value : swing) {
    value = static_cast<float>(std::abs(value - rest));
    largest = std::max(largest, static_cast<double>(value));
  }
  const double noise = 1.4826 * median_of(swing);
  std::vector<long> begins;
  if (!(largest > kClear * noise)) {
    return begins;
  }
  // The first one tells the direction: an input without direct current swings back after a pulse.
  const auto beyond =
      std::ranges::find_if(swing, [&](float value) { return value > 0.5 * largest; });
  const float sign =
      channel[static_cast<std::size_t>(beyond - swing.begin())] > rest ? 1.0F : -1.0F;
  long last = -static_cast<long>(kApart * rate) - 1;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    if (sign * (channel[i] - rest) > 0.5 * largest) {
      const auto at = static_cast<long>(i);
      if (static_cast<double>(at - last) > kApart * rate) {
        begins.push_back(at);
      }
      last = at;
    }
  }
  return begins;
}

/// How well the sound fits behind the silence before `at`.
double fit_at(std::span<const float> recorded, std::span<const float> sound, long at,
              long silence) {
  double product = 0.0;
  double own = 0.0;
  double all = 0.0;
  for (long i = std::max(-silence, -at); i < static_cast<long>(sound.size()); ++i) {
    const double x = recorded[static_cast<std::size_t>(at + i)];
    const double t = i < 0 ? 0.0 : sound[static_cast<std::size_t>(i)];
    product += t * x;
    own += t * t;
    all += x * x;
  }
  return own > 0.0 && all > 0.0 ? product * product / (own * all) : 0.0;
}

}  // namespace

std::vector<HeardOnset> onset_latencies(std::span<const float> pulses,
                                        std::span<const float> recorded,
                                        std::span<const float> sound, double rate) {
  const auto samples = [rate](double seconds) { return std::lround(seconds * rate); };
  sound = sound.first(std::min(sound.size(), static_cast<std::size_t>(samples(kCompared))));
  const long last = static_cast<long>(recorded.size()) - static_cast<long>(sound.size());
  std::vector<HeardOnset> onsets;
  for (const long pulse : begins_of(pulses, rate)) {
    HeardOnset onset{static_cast<double>(pulse) / rate};
    double best = kLeastFit;
    for (long at = std::max(0L, pulse - samples(kBefore));
         at <= std::min(last, pulse + samples(kAfter)); ++at) {
      const double fit = fit_at(recorded, sound, at, samples(kSilence));
      if (fit > best) {
        best = fit;
        onset.latency = static_cast<double>(at - pulse) / rate;
        onset.heard = true;
      }
    }
    onsets.push_back(onset);
  }
  return onsets;
}

}  // namespace haptrial::sound
