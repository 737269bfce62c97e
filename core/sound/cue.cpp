#include "core/sound/cue.h"

#include <fmt/format.h>
#include <gsl/gsl_fft_halfcomplex.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/sound/card_player.h"
#include "core/sound/wav.h"

namespace haptrial::sound {

double amplitude_of(double level) noexcept { return std::pow(10.0, level / 20.0); }

std::vector<float> noise_loop(const NoiseColour& colour, std::size_t size, double rate,
                              double level, std::uint64_t seed, const std::string& name) {
  if (size < 16 || !std::has_single_bit(size)) {
    throw std::invalid_argument("noise_loop: size must be a power of two, 16 or more");
  }
  if (!(colour.low >= 0.0 && colour.high > colour.low && colour.high < 0.5 * rate)) {
    throw std::invalid_argument("noise_loop: low and high must rise and lie below half the rate");
  }
  RandomStream random(seed, name);
  const double bin = rate / static_cast<double>(size);
  std::vector<double> line(size, 0.0);  // GSL's half-complex order: real k, imaginary size - k
  double power = 0.0;
  for (std::size_t k = 1; k < size / 2; ++k) {
    const double frequency = bin * static_cast<double>(k);
    const double real = random.normal();
    const double imaginary = random.normal();
    if (frequency < colour.low || frequency > colour.high) {
      continue;
    }
    const double share = colour.kind == NoiseColour::Kind::kPink ? 1.0 / std::sqrt(frequency) : 1.0;
    line[k] = share * real;
    line[size - k] = share * imaginary;
    power += share * share * (real * real + imaginary * imaginary);
  }
  if (!(power > 0.0)) {
    throw std::invalid_argument("noise_loop: no line lies between low and high");
  }
  gsl_fft_halfcomplex_radix2_backward(line.data(), 1, size);
  const double scale = amplitude_of(level) / std::sqrt(2.0 * power);  // Parseval
  std::vector<float> samples(size);
  for (std::size_t i = 0; i < size; ++i) {
    samples[i] = static_cast<float>(scale * line[i]);
  }
  return samples;
}

namespace {

constexpr int kMostChannels = 32;

const Schema<Actuator>& actuator_schema() {
  using A = Actuator;
  static const auto schema =
      Schema<A>()
          .integer("channel", &A::channel, 1, kMostChannels,
                   "Channel of the sound card on which the actuator is, from 1")
          .required()
          .number("full_scale", &A::full_scale, {0.0, 1e6, true}, "",
                  "Peak that a signal of full scale gives, in the actuator's unit, as it was "
                  "calibrated")
          .required()
          .text("unit", &A::unit, "Unit of the actuator's amplitudes: m/s², g, N")
          .required()
          .number("lowest", &A::lowest, {1.0, 20'000.0}, "Hz",
                  "Lowest frequency for which the calibration holds")
          .number("highest", &A::highest, {1.0, 20'000.0}, "Hz",
                  "Highest frequency for which the calibration holds")
          .check([](Table& table, A& actuator) {
            if (!(actuator.highest > actuator.lowest)) {
              table.reject("highest", "must be above lowest; change one of them");
            }
          });
  return schema;
}

}  // namespace

std::vector<Actuator> read_actuators(Table& root) {
  std::vector<Actuator> actuators;
  if (!root.has("actuators")) {
    return actuators;
  }
  Table table = root.table("actuators");
  for (const std::string& name : table.keys_as_written()) {
    Table own = table.table(name);
    Actuator actuator = actuator_schema().read(own);
    actuator.name = name;
    const auto same = std::ranges::find(actuators, actuator.channel, &Actuator::channel);
    if (same != actuators.end()) {
      own.reject("channel",
                 fmt::format("is that of {}, too; each actuator has its own", same->name));
    }
    actuators.push_back(std::move(actuator));
  }
  return actuators;
}

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
