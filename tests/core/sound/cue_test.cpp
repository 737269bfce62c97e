#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/sound/cue.h"
#include "core/sound/power_spectrum.h"
#include "core/sound/read_cues.h"
#include "core/sound/wav.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::sound::cue_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRate = 48'000.0;

double level_of(std::span<const float> samples) {
  double sum = 0.0;
  for (const float sample : samples) {
    sum += static_cast<double>(sample) * sample;
  }
  return 10.0 * std::log10(sum / static_cast<double>(samples.size()));
}

CueSet read(const std::string& text) {
  Table root = Table::parse(text, "study.toml");
  Table table = root.table("sounds");
  CueSet set = read_cues(table);
  root.finish();
  return set;
}

std::string problem(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(CueTest, AToneHasItsFrequencyLevelAndRamps) {
  Cue cue;
  cue.frequency = 1500.0;  // 32 samples a period
  cue.duration = 0.5;
  cue.level = -20.0;
  cue.rise = 0.01;
  const auto samples = rendered(cue, 1);
  ASSERT_EQ(samples.size(), 24'000u);
  const std::span<const float> steady = std::span(samples).subspan(480, 23'040);
  EXPECT_NEAR(level_of(steady), -20.0, 1e-3);
  EXPECT_NEAR(*std::ranges::max_element(steady), 0.1 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(dominant(find_peaks(power_spectrum(steady, kRate, 4096))), 1500.0, 1.0);
  // Half way up the ramp the gain is a half.
  float most = 0.0F;
  for (std::size_t i = 224; i < 256; ++i) {
    most = std::max(most, std::abs(samples[i]));
  }
  EXPECT_NEAR(most, 0.5 * 0.1 * std::sqrt(2.0), 0.006);
  EXPECT_LT(std::abs(samples.back()), 1e-4);
}

TEST(CueTest, ABurstHasItsLevelAndBand) {
  Cue cue;
  cue.name = "hiss";
  cue.kind = Cue::Kind::kNoise;
  cue.colour = {NoiseColour::Kind::kBand, 1000.0, 4000.0};
  cue.duration = 0.3;
  cue.level = -25.0;
  cue.rise = 0.0;
  const auto samples = rendered(cue, 5);
  ASSERT_EQ(samples.size(), 14'400u);
  EXPECT_NEAR(level_of(samples), -25.0, 1e-3);
  const PowerSpectrum spectrum = power_spectrum(samples, kRate, 2048);
  double inside = 0.0, all = 0.0;
  for (std::size_t i = 0; i < spectrum.power.size(); ++i) {
    const double frequency = spectrum.bin * static_cast<double>(i);
    inside += frequency > 950.0 && frequency < 4050.0 ? spectrum.power[i] : 0.0;
    all += spectrum.power[i];
  }
  EXPECT_GT(inside / all, 0.999);
  EXPECT_EQ(samples, rendered(cue, 5));
  EXPECT_NE(samples, rendered(cue, 6));
}

TEST(CueTest, AClickIsAPulse) {
  Cue cue;
  cue.kind = Cue::Kind::kClick;
  cue.duration = 0.001;
  cue.level = -6.0;
  EXPECT_EQ(rendered(cue, 1), std::vector<float>(48, static_cast<float>(std::pow(10.0, -0.3))));
}

TEST(CueTest, AFileIsPlayedAsItIs) {
  const test::TemporaryFolder folder;
  const std::vector<float> recorded{0.0F, 0.5F, -0.5F, 0.25F};
  WavWriter writer(folder / "beep.wav", 48'000);
  writer.write(recorded);
  writer.finish();
  Cue cue;
  cue.kind = Cue::Kind::kFile;
  cue.file = folder / "beep.wav";
  cue.level = 0.0;
  const auto samples = rendered(cue, 1);
  ASSERT_EQ(samples.size(), recorded.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_NEAR(samples[i], recorded[i], 1e-4);
  }
  cue.level = -6.0206;
  EXPECT_NEAR(rendered(cue, 1)[1], 0.25, 1e-4);
}

TEST(CueTest, AFileOfAnotherRateGetsASentence) {
  const test::TemporaryFolder folder;
  WavWriter writer(folder / "beep.wav", 44'100);
  writer.write(std::vector<float>(100, 0.1F));
  writer.finish();
  Cue cue;
  cue.kind = Cue::Kind::kFile;
  cue.file = folder / "beep.wav";
  try {
    rendered(cue, 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("44100 samples a second; allowed: 48000"));
  }
  cue.file = folder / "absent.wav";
  EXPECT_THROW(rendered(cue, 1), InputError);
}

TEST(CueTest, ATableIsRead) {
  const CueSet set = read(R"([sounds]
device = "null"
[sounds.go]
type = "tone"
frequency = 880.0
duration = 0.2
level = -20.0
[sounds.hiss]
type = "noise"
duration = 0.1
level = -30.0
colour = "band"
low = 500.0
high = 1000.0
[sounds.masking]
level = -35.0
stages = ["press"]
fade = 0.2
[sounds.click]
type = "click"
level = -10.0
)");
  EXPECT_EQ(set.device, "null");
  ASSERT_EQ(set.cues.size(), 3u);
  EXPECT_EQ(set.cues[0].name, "go");
  EXPECT_EQ(set.cues[0].frequency, 880.0);
  EXPECT_EQ(set.cues[1].colour.high, 1000.0);
  EXPECT_EQ(set.cues[2].duration, 0.001);
  ASSERT_TRUE(set.masking);
  EXPECT_EQ(set.masking->colour.kind, NoiseColour::Kind::kPink);
  EXPECT_THAT(set.masking->stages, ElementsAre("press"));
}

TEST(CueTest, MistakesGetASentence) {
  EXPECT_THAT(problem("[sounds.go]\ntype = \"beep\"\n"), HasSubstr("tone, noise, click, file"));
  EXPECT_THAT(problem("[sounds.go]\ntype = \"click\"\nlevel = 0.0\n"), HasSubstr("level is 0"));
  EXPECT_THAT(problem("[sounds.go]\ntype = \"tone\"\nfrequency = 500.0\nlevel = -20.0\n"
                      "duration = 0.006\n"),
              HasSubstr("leaves nothing between the ramps"));
  EXPECT_THAT(problem("[sounds.masking]\nlevel = -20.0\ncolour = \"band\"\nlow = 900.0\n"
                      "high = 300.0\n"),
              HasSubstr("high must be above low"));
  EXPECT_THAT(problem("[sounds.masking]\nlevel = -20.0\nduration = 2.0\n"), HasSubstr("duration"));
}

}  // namespace
}  // namespace haptrial::sound::cue_test

namespace haptrial::sound::noise_test {
namespace {

// Noises against what defines them: power by octave, edges of a band, level.

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
