// Noises against what defines them: power by octave, edges of a band, level.

#include "core/sound/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/sound/power_spectrum.h"

namespace haptrial::sound::noise_test {
namespace {

constexpr double kRate = 48'000.0;
constexpr std::size_t kSize = 1 << 19;
using Kind = NoiseColour::Kind;

double rms(const std::vector<float>& samples) {
  double sum = 0.0;
  for (const float sample : samples) {
    sum += static_cast<double>(sample) * sample;
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

/// Mean square between two frequencies.
double power_in(const PowerSpectrum& spectrum, double low, double high) {
  double sum = 0.0;
  for (std::size_t i = 0; i < spectrum.power.size(); ++i) {
    const double frequency = spectrum.bin * static_cast<double>(i);
    sum += frequency >= low && frequency < high ? spectrum.power[i] : 0.0;
  }
  return sum;
}

double decibel(double ratio) { return 10.0 * std::log10(ratio); }

TEST(NoiseTest, HasTheLevelThatIsAskedFor) {
  for (const double level : {-40.0, -20.0, -12.5}) {
    for (const Kind kind : {Kind::kWhite, Kind::kPink, Kind::kBand}) {
      const auto noise = noise_loop({kind, 300.0, 3000.0}, 1 << 15, kRate, level, 1, "a");
      EXPECT_NEAR(20.0 * std::log10(rms(noise)), level, 1e-4);
    }
  }
}

/// Welch's estimate over 255 segments: an octave of n lines is known within sqrt(1 / (128 n)).
TEST(NoiseTest, PinkHasTheSamePowerInEveryOctave) {
  const auto noise = noise_loop({Kind::kPink}, kSize, kRate, -20.0, 7, "masking");
  const PowerSpectrum spectrum = power_spectrum(noise, kRate, 4096);
  double lowest = 1e9, highest = 0.0;
  for (double low = 125.0; low < 16'000.0; low *= 2.0) {
    const double power = power_in(spectrum, low, 2.0 * low);
    lowest = std::min(lowest, power);
    highest = std::max(highest, power);
  }
  EXPECT_LT(decibel(highest / lowest), 0.5);
  // A hertz has 3.01 dB less with each octave.
  const double low = power_in(spectrum, 250.0, 500.0) / 250.0;
  const double high = power_in(spectrum, 8000.0, 16'000.0) / 8000.0;
  EXPECT_NEAR(decibel(low / high) / 5.0, 3.01, 0.08);
}

TEST(NoiseTest, WhiteHasTheSamePowerInEveryHertz) {
  const auto noise = noise_loop({Kind::kWhite}, kSize, kRate, -20.0, 7, "masking");
  const PowerSpectrum spectrum = power_spectrum(noise, kRate, 4096);
  for (double low = 250.0; low < 16'000.0; low *= 2.0) {
    const double density = power_in(spectrum, low, 2.0 * low) / low;
    EXPECT_NEAR(decibel(density / (0.01 / 19'980.0)), 0.0, 0.4) << low;
  }
}

TEST(NoiseTest, ABandHasNothingBesideItsEdges) {
  const auto noise = noise_loop({Kind::kBand, 500.0, 2000.0}, kSize, kRate, -20.0, 3, "band");
  const PowerSpectrum spectrum = power_spectrum(noise, kRate, 8192);  // bins of 5.9 Hz
  const double all = power_in(spectrum, 0.0, 24'000.0);
  EXPECT_NEAR(power_in(spectrum, 490.0, 2010.0) / all, 1.0, 1e-4);
  EXPECT_LT(power_in(spectrum, 0.0, 450.0) / all, 1e-6);
  EXPECT_LT(power_in(spectrum, 2050.0, 24'000.0) / all, 1e-6);
  EXPECT_NEAR(power_in(spectrum, 500.0, 1250.0) / all, 0.5, 0.02) << "flat within";
}

TEST(NoiseTest, RepeatsWithoutAClick) {
  constexpr std::size_t kShort = 1 << 14;
  const auto once = noise_loop({Kind::kBand, 500.0, 2000.0}, kShort, kRate, -20.0, 3, "band");
  std::vector<float> twice(once.begin() + kShort / 2, once.end());
  twice.insert(twice.end(), once.begin(), once.begin() + kShort / 2);
  const PowerSpectrum across = power_spectrum(twice, kRate, 4096);
  EXPECT_LT(power_in(across, 2300.0, 24'000.0) / power_in(across, 0.0, 24'000.0), 1e-6)
      << "a jump has power at every frequency";
}

TEST(NoiseTest, IsOfItsSeedAndName) {
  const NoiseColour pink{Kind::kPink};
  const auto one = noise_loop(pink, 1024, kRate, -20.0, 7, "a");
  EXPECT_EQ(one, noise_loop(pink, 1024, kRate, -20.0, 7, "a"));
  EXPECT_NE(one, noise_loop(pink, 1024, kRate, -20.0, 8, "a"));
  EXPECT_NE(one, noise_loop(pink, 1024, kRate, -20.0, 7, "b"));
}

TEST(NoiseTest, RefusesWhatIsNoNoise) {
  EXPECT_THROW(noise_loop({}, 1000, kRate, -20.0, 1, "a"), std::invalid_argument);
  EXPECT_THROW(noise_loop({Kind::kBand, 900.0, 800.0}, 1024, kRate, -20.0, 1, "a"),
               std::invalid_argument);
  EXPECT_THROW(noise_loop({Kind::kBand, 100.0, 24'000.0}, 1024, kRate, -20.0, 1, "a"),
               std::invalid_argument);
  EXPECT_THROW(noise_loop({Kind::kBand, 100.0, 101.0}, 1024, kRate, -20.0, 1, "a"),
               std::invalid_argument)
      << "no line of 47 Hz lies there";
}

}  // namespace
}  // namespace haptrial::sound::noise_test
