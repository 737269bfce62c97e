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
constexpr double kQuiet = 0.05;     // before the sound, which tells the noise [s]
constexpr double kOut = 5.0;        // times the noise, above which a sample stands out
constexpr double kByNoise = 4.5;    // times the noise, beyond which none of thousands of samples is
constexpr double kLeastOut = 1e-3;  // of the sound, where there is no noise

double median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The standard deviation of noise about `rest`, whatever stands out of it.
double noise_of(std::span<const float> samples, double rest) {
  std::vector<float> amounts;
  for (const float sample : samples) {
    amounts.push_back(static_cast<float>(std::abs(sample - rest)));
  }
  return 1.4826 * median_of(amounts);
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

/// Sums of the squares of the samples before each.
std::vector<double> energies_of(std::span<const float> samples) {
  std::vector<double> sums{0.0};
  for (const float sample : samples) {
    sums.push_back(sums.back() + static_cast<double>(sample) * sample);
  }
  return sums;
}

double product_of(std::span<const float> one, std::span<const float> other) {
  double sum = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    sum += static_cast<double>(one[i]) * other[i];
  }
  return sum;
}

/// A recorded channel and the sound that is looked for in it.
class Search {
 public:
  Search(std::span<const float> recorded, std::span<const float> sound, double rate)
      : recorded_(recorded),
        sound_(sound.first(std::min(sound.size(), static_cast<std::size_t>(kCompared * rate)))),
        rate_(rate),
        energies_(energies_of(recorded)),
        own_(energies_of(sound_).back()) {
    for (const float sample : sound_) {
      largest_ = std::max(largest_, std::abs(static_cast<double>(sample)));
    }
  }

  HeardOnset after(long pulse) const {
    HeardOnset onset{static_cast<double>(pulse) / rate_};
    const long first = std::max(0L, pulse - samples(kBefore));
    const long last = static_cast<long>(recorded_.size()) - static_cast<long>(sound_.size());
    double best = kLeastFit;
    for (long at = first; at <= std::min(last, pulse + samples(kAfter)); ++at) {
      if (const double fit = fit_at(at); fit > best) {
        best = fit;
        onset.latency = static_cast<double>(at - pulse) / rate_;
        onset.heard = true;
      }
    }
    if (onset.heard) {
      look_out_of_noise(onset, first, pulse);
    }
    return onset;
  }

 private:
  long samples(double seconds) const { return std::lround(seconds * rate_); }
  /// The first of the samples whose amount, from `rest`, is above a threshold; their number if
  /// none.
  static long first_above(std::span<const float> samples, double rest, double threshold) {
    return std::ranges::find_if(samples,
                                [&](float sample) { return std::abs(sample - rest) > threshold; }) -
           samples.begin();
  }

  /// @param first  sample from which the sound is looked for
  void look_out_of_noise(HeardOnset& onset, long first, long pulse) const {
    const long quiet = std::max(0L, first - samples(kQuiet));
    if (quiet == first) {
      onset.left = onset.latency;
      return;
    }
    const auto before =
        recorded_.subspan(static_cast<std::size_t>(quiet), static_cast<std::size_t>(first - quiet));
    const double rest = median_of({before.begin(), before.end()});
    const double noise = noise_of(before, rest);
    const long at = pulse + std::lround(onset.latency * rate_);
    const double gain =
        product_of(sound_, recorded_.subspan(static_cast<std::size_t>(at), sound_.size())) / own_;
    const double least = kLeastOut * std::abs(gain) * largest_;
    const auto would = [&](double times) {
      return at + first_above(sound_, 0.0, std::max(times * noise, least) / std::abs(gain));
    };
    const long left = first + first_above(recorded_.subspan(static_cast<std::size_t>(first)), rest,
                                          std::max(kOut * noise, least));
    const long next = std::clamp(left, would(kOut - kByNoise), would(kOut + kByNoise));
    onset.left = static_cast<double>(left - pulse) / rate_;
    onset.off = static_cast<double>(left - next) / rate_;
  }

  double fit_at(long at) const {
    const auto from = static_cast<std::size_t>(at);
    const auto silence = static_cast<std::size_t>(std::max(0L, at - samples(kSilence)));
    const double product = product_of(sound_, recorded_.subspan(from, sound_.size()));
    const double all = own_ * (energies_[from + sound_.size()] - energies_[silence]);
    return all > 0.0 ? product * product / all : 0.0;
  }

  std::span<const float> recorded_, sound_;
  double rate_;
  std::vector<double> energies_;
  double own_;           // energy of the sound
  double largest_{0.0};  // amount of its samples
};

}  // namespace

std::vector<HeardOnset> onset_latencies(std::span<const float> pulses,
                                        std::span<const float> recorded,
                                        std::span<const float> sound, double rate) {
  const Search search(recorded, sound, rate);
  std::vector<HeardOnset> onsets;
  for (const long pulse : begins_of(pulses, rate)) {
    onsets.push_back(search.after(pulse));
  }
  return onsets;
}

}  // namespace haptrial::sound
