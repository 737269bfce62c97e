#include "core/sound/speech_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/sound/cue_player.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::sound::speech_track_test {
namespace {

constexpr double kRate = 48'000.0;

TEST(SpeechTrackTest, FadesWithin5Milliseconds) {
  SpeechTrack track(kRate);
  std::vector<float> samples(480, 0.0F);
  track.start(std::vector<float>(4800, 0.5F));
  track.add(samples);
  EXPECT_EQ(samples, std::vector<float>(480, 0.5F));
  track.stop();
  std::ranges::fill(samples, 0.0F);
  track.add(samples);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_LE(samples[i], samples[i - 1]);
    ASSERT_GT(samples[i], samples[i - 1] - 0.01F) << "no step";
  }
  EXPECT_EQ(samples[240], 0.0F);
  EXPECT_FALSE(track.sounds());
}

TEST(SpeechTrackTest, EndsWithItsClipAndStaysWithinFullScale) {
  SpeechTrack track(kRate);
  track.start({0.75F, 0.75F});
  std::vector<float> samples(3, 0.5F);
  track.add(samples);
  EXPECT_EQ(samples, (std::vector<float>{1.0F, 1.0F, 0.5F}));
  EXPECT_FALSE(track.sounds());
}

/// Samples that a card was given, which ALSA wrote to a file.
std::vector<float> samples_in(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<float> samples(bytes.size() / sizeof(float));
  std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(float));
  return samples;
}

/// A rectangular pulse, all of whose samples are the same.
Cue pulse() {
  Cue cue;
  cue.name = "pulse";
  cue.kind = Cue::Kind::kClick;
  cue.duration = 0.25;
  cue.level = -20.0;
  return cue;
}

constexpr float kSpeech = 0.55F;

// A sound cuts speech, and speech waits for a sound: no sample is the sum of both.
TEST(SpokenCuesTest, SpeechAndSoundsAreNeverHeardTogether) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "played.raw";
  const std::vector<float> sound = rendered(pulse(), 1);
  const float level = sound[sound.size() / 2];
  {
    CuePlayer player({{pulse()}, {}, "tee:null," + file.string() + ",raw"}, 1, [] { return 7; });
    player.say(std::vector<float>(480'000, kSpeech), 1);
    std::vector<StartedCue> said;
    const auto is_said = [&] {
      said = player.take_said();
      return !said.empty();
    };
    test::wait_until(is_said);
    EXPECT_EQ(said.front().ticket, 1u);
    EXPECT_EQ(said.front().handed_ns, 7);
    player.start(0, 11);
    player.say(std::vector<float>(4800, kSpeech), 2);
    test::wait_until([&] { return !player.take_started().empty(); });
    test::wait_until(is_said);
    EXPECT_EQ(said.front().ticket, 2u);
    test::wait_until([&] { return !player.speaks(); });
  }
  const std::vector<float> played = samples_in(file);
  const auto begin = std::ranges::find(played, level);
  ASSERT_NE(begin, played.end());
  const auto end = begin + static_cast<std::ptrdiff_t>(sound.size());
  EXPECT_TRUE(std::equal(begin, end, sound.begin())) << "the sound is whole, and alone";
  EXPECT_LT(*(begin - 1), 0.01F) << "the speech has faded";
  EXPECT_GT(std::count(played.begin(), begin, kSpeech), 0);
  EXPECT_EQ(std::count(end, played.end(), kSpeech), 4800) << "all of what waited";
}

TEST(SpokenCuesTest, NothingIsSaidOverMaskingNoise) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "played.raw";
  {
    Masking masking;
    masking.fade = 0.02;
    CuePlayer player({{}, masking, "tee:null," + file.string() + ",raw"}, 1, [] { return 7; });
    player.mask(true);
    player.say(std::vector<float>(4800, kSpeech), 1);
    EXPECT_FALSE(test::happens_within(0.2, [&] { return !player.take_said().empty(); }));
    EXPECT_TRUE(player.speaks());
    player.forget();
    EXPECT_FALSE(player.speaks());
    player.say(std::vector<float>(4800, kSpeech), 2);
    player.mask(false);
    test::wait_until([&] { return !player.take_said().empty(); });
    test::wait_until([&] { return !player.speaks(); });
  }
  const std::vector<float> played = samples_in(file);
  EXPECT_EQ(std::ranges::count(played, kSpeech), 4800) << "each sample without noise";
}

}  // namespace
}  // namespace haptrial::sound::speech_track_test
