// The sound of a live drilling, through ALSA into a file that stands in for a sound card.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/sound/power_spectrum.h"
#include "core/sound/sound_output.h"
#include "core/sound/wav.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A configuration of ALSA whose card is a file of raw samples.
void write_card(const fs::path& configuration, const fs::path& samples) {
  test::write_text(configuration,
                   "pcm.!default {\n  type file\n  slave.pcm { type null }\n"
                   "  file \"" +
                       samples.string() + "\"\n  format \"raw\"\n}\n");
}

std::vector<float> read_samples(const fs::path& file) {
  const std::string bytes = test::read_text(file);
  std::vector<float> samples(bytes.size() / sizeof(float));
  std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(float));
  return samples;
}

/// The frequency with the most power [Hz].
double loudest(const std::vector<float>& samples) {
  const auto spectrum = sound::power_spectrum(samples, sound::DrillSound::kRate, 4096);
  const auto peak = std::max_element(spectrum.power.begin(), spectrum.power.end());
  return spectrum.bin * static_cast<double>(peak - spectrum.power.begin());
}

TEST(LiveSoundTest, TheCardIsGivenTheDrillsSoundWhileTheLoopKeepsItsTime) {
  const test::TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> lines{{"card", "card = true"},
                                                               {"thin_rise", "thin_rise = 0.0"}};
  constexpr double kSeconds = 4.0;
  test::write_small_drilling(folder.path(), kSeconds, lines);
  write_card(folder / "card.conf", folder / "card.raw");
  const auto start = std::chrono::steady_clock::now();
  test::LiveCommand session("run '" + (folder / "study.toml").string() + "' --subject S01 --out '" +
                                (folder / "out").string() + "'",
                            "export ALSA_CONFIG_PATH='" + (folder / "card.conf").string() + "'");
  const test::CommandResult ended = session.wait();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr(" 0 lost records"));

  const std::vector<float> samples = read_samples(folder / "card.raw");
  constexpr double kRate = sound::DrillSound::kRate;
  EXPECT_GT(static_cast<double>(samples.size()), 0.5 * kSeconds * kRate);
  EXPECT_LT(static_cast<double>(samples.size()), (passed.count() + 1.0) * kRate)
      << "no faster than it is heard";
  const auto loud = [](float x) { return std::abs(x) > 1e-4F; };
  EXPECT_GT(std::count_if(samples.begin(), samples.end(), loud), kSeconds * kRate / 8);

  // The strongest line is the table's: a load slows it to 0.88 of what it is in the air at most.
  const sound::Spectrum free = sound::default_sound().of(sound::Burr::kCutting).free[0].spectrum;
  const sound::Peak strongest =
      *std::max_element(free.peaks.begin(), free.peaks.begin() + free.count,
                        [](const auto& a, const auto& b) { return a.amplitude < b.amplitude; });
  const double heard = loudest(samples);
  EXPECT_GT(heard, 0.86 * strongest.frequency);
  EXPECT_LT(heard, 1.02 * strongest.frequency);

  // Sound according to the record, by another way.
  const fs::path file = folder / "out" / "S01.h5";
  const fs::path track = folder / "track.wav";
  const test::CommandResult replay =
      test::run_command("haptrial replay '" + file.string() + "' --sound '" + track.string() + "'");
  ASSERT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("the same bone"));
  EXPECT_NEAR(heard, loudest(sound::read_recording(track).samples), 0.03 * heard);
}

}  // namespace
}  // namespace haptrial
