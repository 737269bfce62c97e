#include "core/sound/power_spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/sound/harmonics.h"
#include "core/sound/wav.h"
#include "tests/core/sound/lines.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::sound::power_spectrum_test {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

TEST(PowerSpectrumTest, TheBinsAddUpToTheMeanSquare) {
  RandomStream random(7, "white");
  std::vector<float> white(1 << 16);
  double square = 0.0;
  for (float& x : white) {
    x = static_cast<float>(0.1 * random.normal());
    square += static_cast<double>(x) * static_cast<double>(x);
  }
  const PowerSpectrum power = power_spectrum(white, 48'000.0);
  double sum = 0.0;
  for (const double bin : power.power) {
    sum += bin;
  }
  EXPECT_NEAR(sum, square / static_cast<double>(white.size()), 0.02 * sum);
  EXPECT_THROW(power_spectrum(white, 48'000.0, 1000), std::invalid_argument);
  EXPECT_THROW(power_spectrum({}, 48'000.0), std::invalid_argument);
}

TEST(PowerSpectrumTest, FindsKnownSinesInNoiseInAFile) {
  const test::TemporaryFolder folder;
  const Spectrum truth = lines({{387.3, 0.05, 0.0},
                                {1139.6, 0.02, 0.0},
                                {2279.2, 0.2, 0.0},
                                {3418.8, 0.03, 0.0},
                                {7001.7, 0.01, 0.0}});
  RandomStream random(8, "noise");
  const double rate = 44'100.0;
  std::vector<float> samples(static_cast<std::size_t>(8.0 * rate));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double x = 0.004 * random.normal();
    for (int k = 0; k < truth.count; ++k) {
      const Peak& peak = truth.peaks[static_cast<std::size_t>(k)];
      x += peak.amplitude * std::cos(kTau * peak.frequency * static_cast<double>(i) / rate + k);
    }
    samples[i] = static_cast<float>(x);
  }
  WavWriter wav(folder / "known.wav", static_cast<int>(rate));
  wav.write(samples);
  wav.finish();
  const Recording recording = read_recording(folder / "known.wav");
  ASSERT_EQ(recording.rate, rate);
  ASSERT_EQ(recording.samples.size(), samples.size());
  const Spectrum found = find_peaks(power_spectrum(recording.samples, rate));
  ASSERT_EQ(found.count, truth.count);
  for (int k = 0; k < truth.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_NEAR(found.peaks[at].frequency, truth.peaks[at].frequency, 1.0);
    EXPECT_NEAR(found.peaks[at].amplitude, truth.peaks[at].amplitude,
                0.01 * truth.peaks[at].amplitude);
  }
  EXPECT_NEAR(found.noise, 0.004, 0.0004);
  EXPECT_NEAR(dominant(found), 2279.2, 1.0);
  EXPECT_NEAR(fundamental(found), 1139.6, 1.0);
}

TEST(PowerSpectrumTest, WhatIsMadeFromARecordingHasItsPeaks) {
  const auto file = test::shared_data("sound/drill.wav");
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds sound/drill.wav";
  }
  const Recording recording = read_recording(*file);
  const Spectrum found = find_peaks(power_spectrum(recording.samples, recording.rate), {.most = 8});
  EXPECT_NEAR(dominant(found), 2279.0, 25.0);  // it wavers
  EXPECT_NEAR(fundamental(found), 1140.0, 15.0);
  Harmonics harmonics(recording.rate, RandomStream(9, "again"), 0.0);
  harmonics.aim(found, 1.0, 1.0);
  const auto made = drawn(harmonics, recording.rate, 20.0);
  const Spectrum again = find_peaks(power_spectrum(made, recording.rate), {.most = 8});
  const Peak* strongest =
      std::max_element(found.peaks.begin(), found.peaks.begin() + found.count,
                       [](const Peak& a, const Peak& b) { return a.amplitude < b.amplitude; });
  int matched = 0;
  for (int i = 0; i < again.count; ++i) {
    const Peak& peak = again.peaks[static_cast<std::size_t>(i)];
    const bool near =
        std::any_of(found.peaks.begin(), found.peaks.begin() + found.count, [&](const Peak& other) {
          return std::abs(other.frequency - peak.frequency) < 10.0 + 0.5 * other.bandwidth;
        });
    matched += near ? 1 : 0;
    if (std::abs(peak.frequency - strongest->frequency) < 10.0) {
      EXPECT_NEAR(peak.amplitude, strongest->amplitude, 0.1 * strongest->amplitude);
    }
  }
  EXPECT_GE(matched, 5);
  EXPECT_EQ(matched, again.count);
  double recorded_square = 0.0;
  double made_square = 0.0;
  for (const double bin : power_spectrum(recording.samples, recording.rate).power) {
    recorded_square += bin;
  }
  for (const double bin : power_spectrum(made, recording.rate).power) {
    made_square += bin;
  }
  EXPECT_NEAR(made_square, recorded_square, 0.05 * recorded_square);
}

}  // namespace
}  // namespace haptrial::sound::power_spectrum_test
