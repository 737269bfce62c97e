#include "core/sound/mixer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/sound/cue_player.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/wait.h"

namespace haptrial::sound::mixer_test {
namespace {

using testing::HasSubstr;

constexpr double kRate = 48'000.0;

std::vector<float> filled(Mixer& mixer, std::size_t count) {
  std::vector<float> samples(count);
  mixer.fill(samples);
  return samples;
}

TEST(MixerTest, AddsWhatFits) {
  Mixer mixer({{0.1F, 0.2F, 0.3F}, {0.5F, 0.5F}}, {}, 0.0, kRate);
  mixer.start(0);
  EXPECT_EQ(filled(mixer, 1), std::vector<float>{0.1F});
  mixer.start(1);
  mixer.start(9);  // none
  const auto rest = filled(mixer, 4);
  EXPECT_FLOAT_EQ(rest[0], 0.7F);
  EXPECT_FLOAT_EQ(rest[1], 0.8F);
  EXPECT_EQ(rest[2], 0.0F);
  EXPECT_EQ(mixer.limited(), 0u) << "the limiter leaves alone what fits";
}

TEST(MixerTest, NeverLeavesFullScaleAndSaysSo) {
  Mixer mixer({std::vector<float>(4800, 0.8F)}, {}, 0.0, kRate);
  mixer.start(0);
  filled(mixer, 100);
  EXPECT_EQ(mixer.limited(), 0u);
  mixer.start(0);
  mixer.start(0);
  for (const float sample : filled(mixer, 4000)) {
    ASSERT_LE(sample, 1.0F);
    ASSERT_GT(sample, 0.99F) << "no softer than it must be";
  }
  EXPECT_EQ(mixer.limited(), 4000u);
  filled(mixer, 10'000);  // all are over
  mixer.start(0);
  EXPECT_EQ(filled(mixer, 10).back(), 0.8F) << "the gain is back";
}

TEST(MixerTest, TheLimiterTakesWhatIsNoNumber) {
  Limiter limiter(kRate);
  EXPECT_EQ(limiter.limited(std::numeric_limits<double>::quiet_NaN()), 0.0F);
  EXPECT_EQ(limiter.limited(std::numeric_limits<double>::infinity()), 0.0F);
  EXPECT_EQ(limiter.limited(-1e9), -1.0F);
}

TEST(MixerTest, WhatIsStilledFadesAndWhatBeginsThenDoesNot) {
  Mixer mixer({std::vector<float>(48'000, 0.5F), std::vector<float>(48'000, 0.25F)}, {}, 0.0,
              kRate);
  std::vector<float> samples(480);
  mixer.start(0);
  mixer.fill(samples);
  EXPECT_EQ(samples.back(), 0.5F);
  mixer.still();
  mixer.start(1);
  mixer.fill(samples);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_LE(samples[i], samples[i - 1]);
    ASSERT_GT(samples[i], samples[i - 1] - 0.01F) << "no step";
  }
  EXPECT_EQ(samples[0], 0.75F);
  for (std::size_t i = 240; i < samples.size(); ++i) {  // 5 ms
    ASSERT_EQ(samples[i], 0.25F);
  }
}

TEST(MixerTest, MaskingFadesInAndOut) {
  Mixer mixer({}, std::vector<float>(1000, 0.4F), 0.1, kRate);
  EXPECT_EQ(filled(mixer, 100), std::vector<float>(100, 0.0F));
  mixer.mask(true);
  const auto in = filled(mixer, 4800);
  EXPECT_NEAR(in[2399], 0.2, 1e-3) << "half of it after half of 0.1 s";
  EXPECT_NEAR(in.back(), 0.4, 1e-3);
  EXPECT_EQ(filled(mixer, 50), std::vector<float>(50, 0.4F));
  mixer.mask(false);
  const auto out = filled(mixer, 5000);
  EXPECT_NEAR(out[2399], 0.2, 1e-3);
  EXPECT_EQ(out.back(), 0.0F);
}

TEST(MixerTest, OneVoiceTooManyEndsTheOldest) {
  Mixer mixer({std::vector<float>(100, 0.01F)}, {}, 0.0, kRate);
  for (int i = 0; i < 20; ++i) {
    mixer.start(0);
  }
  EXPECT_NEAR(filled(mixer, 1)[0], 0.16F, 1e-6);
}

TEST(MixerTest, FillsWithoutAllocation) {
  Mixer mixer({std::vector<float>(100, 0.01F)}, std::vector<float>(64, 0.1F), 0.1, kRate);
  std::vector<float> samples(240);
  const test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    mixer.start(0);
    mixer.mask(i % 2 == 0);
    mixer.fill(samples);
  }
  EXPECT_EQ(guard.count(), 0u);
}

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

CueSet beep(const std::string& device) {
  Cue cue;
  cue.name = "beep";
  return {{cue}, Masking{}, device};
}

TEST(CuePlayerTest, SaysWhenTheCardTookWhatWasStarted) {
  CuePlayer player(beep("null"), 1, now);  // ALSA's card that swallows everything
  const std::int64_t begin = now();
  player.start(0, 17);
  std::vector<StartedCue> started;
  test::wait_until([&] {
    started = player.take_started();
    return !started.empty();
  });
  ASSERT_EQ(started.size(), 1u);
  EXPECT_EQ(started[0].ticket, 17u);
  EXPECT_GE(started[0].handed_ns, begin);
  EXPECT_LE(started[0].handed_ns, now());
  EXPECT_EQ(player.trouble(), "");
}

TEST(CuePlayerTest, WithoutACardThereIsASentence) {
  try {
    const CuePlayer player(beep("hw:no-such-card"), 1, now);
    FAIL() << "a card that is not there was opened";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("sound card 'hw:no-such-card'"));
  }
}

}  // namespace
}  // namespace haptrial::sound::mixer_test
