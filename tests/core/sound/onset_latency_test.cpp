// The latency of sounds in loopback recordings with planted onsets.

#include "core/sound/onset_latency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/sound/card_player.h"
#include "core/sound/cue.h"

namespace haptrial::sound {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr double kRate = CardPlayer::kRate;
constexpr double kNoise = 0.02;  // of both channels, beside a pulse of 0.5 and a sound of 0.3

Cue cue_of(Cue::Kind kind, double frequency, double duration, double rise) {
  Cue cue;
  cue.kind = kind;
  cue.frequency = frequency;
  cue.duration = duration;
  cue.rise = rise;
  return cue;
}

struct Loopback {
  std::vector<float> pulses, sound;
};

/// Five onsets, one a second, through an input that lets no direct current pass.
Loopback loopback(const std::vector<float>& cue, double latency, double noise = kNoise) {
  RandomStream random(3, "loopback");
  const auto count = static_cast<std::size_t>(5.0 * kRate);
  Loopback made{std::vector<float>(count), std::vector<float>(count)};
  float largest = 0.0F;
  for (const float sample : cue) {
    largest = std::max(largest, std::abs(sample));
  }
  double charge = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double since = std::fmod(static_cast<double>(i) / kRate, 1.0) - 0.25;
    const double level = since >= 0.0 && since < 0.01 ? 0.5 : 0.0;
    charge += (level - charge) / (0.02 * kRate);  // 50 Hz
    made.pulses[i] = static_cast<float>(level - charge + noise * random.normal());
    const auto at = std::lround((since - latency) * kRate);
    const bool sounds = at >= 0 && at < static_cast<long>(cue.size());
    made.sound[i] = static_cast<float>(
        (sounds ? -0.3 * cue[static_cast<std::size_t>(at)] / largest : 0.0) +  // turned round
        noise * random.normal());
  }
  return made;
}

TEST(OnsetLatencyTest, PlantedLatenciesAreFoundWithinATenthOfAMillisecond) {
  const Cue tone = cue_of(Cue::Kind::kTone, 250.0, 0.4, 0.02);
  const Cue beep = cue_of(Cue::Kind::kTone, 1000.0, 0.05, 0.005);
  const Cue click = cue_of(Cue::Kind::kClick, 0.0, 0.001, 0.0);
  for (const Cue& cue : {tone, beep, click}) {
    const std::vector<float> samples = rendered(cue, 1);
    for (const double latency : {0.0, 0.005, 0.0373}) {
      const Loopback made = loopback(samples, latency);
      const auto found = onset_latencies(made.pulses, made.sound, samples, kRate);
      ASSERT_THAT(found, SizeIs(5)) << cue.duration;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_TRUE(found[i].heard) << cue.duration;
        EXPECT_NEAR(found[i].pulse, 0.25 + static_cast<double>(i), 1e-4) << cue.duration;
        EXPECT_NEAR(found[i].latency, latency, 1e-4) << cue.duration;
        EXPECT_NEAR(found[i].off, 0.0, 3e-3) << cue.duration;
      }
    }
  }
}

/// The acceleration of an actuator that is driven by `force`: a mass on a spring.
std::vector<float> moved(const std::vector<float>& force, double frequency, double damping_ratio) {
  const double omega = 2.0 * std::numbers::pi * frequency;
  double place = 0.0;
  double speed = 0.0;
  std::vector<float> accelerations;
  for (const float push : force) {
    const double a = push - 2.0 * damping_ratio * omega * speed - omega * omega * place;
    speed += a / kRate;
    place += speed / kRate;
    accelerations.push_back(static_cast<float>(a));
  }
  return accelerations;
}

TEST(OnsetLatencyTest, AnActuatorThatRingsUpLeavesTheNoiseBeforeThePlaceThatFitsBest) {
  constexpr double kLatency = 0.0123;
  const std::vector<float> tone = rendered(cue_of(Cue::Kind::kTone, 250.0, 0.2, 0.005), 1);
  for (const double damping : {0.05, 0.1}) {
    const Loopback made = loopback(moved(tone, 250.0, damping), kLatency, 0.003);
    const auto found = onset_latencies(made.pulses, made.sound, tone, kRate);
    ASSERT_THAT(found, SizeIs(5));
    for (const HeardOnset& onset : found) {
      EXPECT_GT(onset.latency, kLatency + 3e-3) << "it fits best where it has rung up";
      EXPECT_LT(onset.off, -2e-3);
      EXPECT_GT(onset.left, kLatency);
      EXPECT_LT(onset.left, kLatency + 4e-3);
    }
  }
  const Loopback alone = loopback(tone, kLatency, 0.003);
  for (const HeardOnset& onset : onset_latencies(alone.pulses, alone.sound, tone, kRate)) {
    EXPECT_NEAR(onset.off, 0.0, 2e-4);
    EXPECT_LT(onset.left, kLatency + 1e-3);
  }
}

/// Hundreds of samples are about as large as the threshold, so that noise lifts some over it.
TEST(OnsetLatencyTest, ASoundThatRisesSlowlyInNoiseIsThisSoundAlone) {
  const std::vector<float> tone = rendered(cue_of(Cue::Kind::kTone, 100.0, 0.5, 0.2), 1);
  const Loopback made = loopback(tone, 0.0123);
  std::vector<double> off;
  for (const HeardOnset& onset : onset_latencies(made.pulses, made.sound, tone, kRate)) {
    off.push_back(onset.off);
  }
  ASSERT_THAT(off, SizeIs(5));
  std::ranges::sort(off);
  EXPECT_LT(std::abs(off[2]), 4e-4) << "the median, of which device-test warns beyond that";
}

TEST(OnsetLatencyTest, WhatIsNotInTheRecordingIsNotFound) {
  const Cue beep = cue_of(Cue::Kind::kTone, 1000.0, 0.05, 0.005);
  const std::vector<float> samples = rendered(beep, 1);
  Loopback made = loopback(samples, 0.6);  // later than is looked for
  for (const HeardOnset& onset : onset_latencies(made.pulses, made.sound, samples, kRate)) {
    EXPECT_FALSE(onset.heard);
  }
  EXPECT_THAT(onset_latencies(made.sound, made.sound, samples, kRate), testing::Not(IsEmpty()));
  const std::vector<float> noise(made.sound.begin(), made.sound.begin() + 10'000);
  EXPECT_THAT(onset_latencies(noise, noise, samples, kRate), IsEmpty());
  const std::vector<float> silence(10'000);
  EXPECT_THAT(onset_latencies(silence, silence, samples, kRate), IsEmpty());
}

}  // namespace
}  // namespace haptrial::sound
