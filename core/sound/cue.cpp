#include "core/sound/cue.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/sound/card_player.h"
#include "core/sound/wav.h"

namespace haptrial::sound {
namespace {

constexpr double kRate = CardPlayer::kRate;

std::size_t samples_of(double duration) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(duration * kRate)));
}

std::vector<float> tone(const Cue& cue) {
  const double amplitude = std::numbers::sqrt2 * amplitude_of(cue.level);
  std::vector<float> samples(samples_of(cue.duration));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * cue.frequency * static_cast<double>(i) / kRate;
    samples[i] = static_cast<float>(amplitude * std::sin(phase));
  }
  return samples;
}

/// A part of a loop, with the level that is asked for.
std::vector<float> burst(const Cue& cue, std::uint64_t seed) {
  constexpr std::size_t kFinest = 1 << 15;  // lines of 1.5 Hz, also of a short burst
  const std::size_t count = samples_of(cue.duration);
  std::vector<float> samples = noise_loop(cue.colour, std::max(kFinest, std::bit_ceil(count)),
                                          kRate, cue.level, seed, "sound " + cue.name);
  samples.resize(count);
  double square = 0.0;
  for (const float sample : samples) {
    square += static_cast<double>(sample) * sample;
  }
  const double scale =
      amplitude_of(cue.level) / std::sqrt(square / static_cast<double>(samples.size()));
  for (float& sample : samples) {
    sample = static_cast<float>(scale * sample);
  }
  return samples;
}

void raise(std::vector<float>& samples, double rise) {
  const std::size_t ramp = std::min(samples.size() / 2, static_cast<std::size_t>(rise * kRate));
  for (std::size_t i = 0; i < ramp; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(ramp);
    const auto gain = static_cast<float>(0.5 - 0.5 * std::cos(std::numbers::pi * share));
    samples[i] *= gain;
    samples[samples.size() - 1 - i] *= gain;
  }
}

std::vector<float> recording(const Cue& cue) {
  Recording read = read_recording(cue.file);
  if (read.rate != kRate) {
    throw InputError(fmt::format(
        "{}: has {:g} samples a second; allowed: {:g}. Convert it: sox {} -r {:g} converted.wav",
        cue.file.string(), read.rate, kRate, cue.file.filename().string(), kRate));
  }
  const auto gain = static_cast<float>(amplitude_of(cue.level));
  for (float& sample : read.samples) {
    sample *= gain;
  }
  return std::move(read.samples);
}

}  // namespace

std::vector<float> rendered(const Cue& cue, std::uint64_t seed) {
  std::vector<float> samples;
  switch (cue.kind) {
    case Cue::Kind::kTone:
      samples = tone(cue);
      raise(samples, cue.rise);
      break;
    case Cue::Kind::kNoise:
      samples = burst(cue, seed);
      raise(samples, cue.rise);
      break;
    case Cue::Kind::kClick:
      samples.assign(samples_of(cue.duration), static_cast<float>(amplitude_of(cue.level)));
      break;
    case Cue::Kind::kFile:
      samples = recording(cue);
      break;
  }
  return samples;
}

std::vector<float> rendered(const Masking& masking, std::uint64_t seed) {
  constexpr std::size_t kSize = 1 << 20;
  return noise_loop(masking.colour, kSize, kRate, masking.level, seed, "sound masking");
}

}  // namespace haptrial::sound
