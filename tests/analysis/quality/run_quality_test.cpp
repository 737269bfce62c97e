#include "analysis/quality/run_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace haptrial::analysis {
namespace {

using record::Sample;
constexpr double kRate = 1000.0;  // [Hz]

/// A run of `seconds` at 1 kHz with the hand at rest; the device saturates at 12 N.
std::vector<Sample> run_of(double seconds, const std::function<double(double)>& force) {
  std::vector<Sample> run;
  const int ticks = static_cast<int>(seconds * kRate) + 1;
  for (int k = 0; k < ticks; ++k) {
    Sample s;
    s.sequence = static_cast<std::uint64_t>(k);
    s.time_ns = 7'000'000'000 + k * 1'000'000LL;
    s.target_force = 6.0;
    const double wanted = force(k / kRate);
    s.saturated = std::abs(wanted) > 12.0;
    s.applied_force = std::clamp(wanted, -12.0, 12.0);
    run.push_back(s);
  }
  return run;
}

double sine(double amplitude, double frequency, double t) {
  return amplitude * std::sin(2.0 * std::numbers::pi * frequency * t);
}

TEST(RunQualityTest, AQuietRunHasDurationPeaksAndNothingElse) {
  const RunQuality q = run_quality(run_of(5.0, [](double t) { return sine(8.0, 0.5, t); }), kRate);
  EXPECT_DOUBLE_EQ(*q.duration, 5.0);
  EXPECT_DOUBLE_EQ(*q.target_peak, 6.0);
  EXPECT_NEAR(*q.peak_force, 8.0, 1e-9);
  EXPECT_EQ(*q.saturation, 0.0);
  EXPECT_EQ(*q.oscillation, 0.0);
  EXPECT_FALSE(q.oscillation_frequency);
  EXPECT_NEAR(*q.missing_ticks, 0.0, 1e-12);
  EXPECT_EQ(*q.late_ticks, 0.0);
  EXPECT_EQ(*q.top_speed, 0.0);
  EXPECT_FALSE(q.reduced_damping) << "not known from the samples";
  EXPECT_FALSE(q.dropped_frames);
}

TEST(RunQualityTest, ARunThatSwingsAtItsLimitHasFrequencyAndShareOfTime) {
  // 250 N cut off at 12 N: at the limit but for 2/pi asin(12/250) of the time.
  const RunQuality q =
      run_quality(run_of(5.0, [](double t) { return sine(250.0, 36.0, t); }), kRate);
  EXPECT_NEAR(*q.saturation, 0.97, 0.01);
  EXPECT_NEAR(*q.oscillation_frequency, 36.0, 0.2);
  EXPECT_NEAR(*q.oscillation, 1.0, 0.01);
  EXPECT_EQ(*q.peak_force, 12.0);
}

TEST(RunQualityTest, OscillationIsTheShareOfTimeInWhichTheForceSwings) {
  for (const double share : {0.2, 0.5}) {
    const RunQuality q = run_quality(
        run_of(10.0, [&](double t) { return t < 10.0 * share ? sine(3.0, 20.0, t) : 0.0; }), kRate);
    EXPECT_NEAR(*q.oscillation, share, 0.01);
    EXPECT_NEAR(*q.oscillation_frequency, 20.0, 0.5);
    EXPECT_EQ(*q.saturation, 0.0);
  }
}

TEST(RunQualityTest, AcrossThePathCountsToo) {
  auto run = run_of(5.0, [](double) { return 3.0; });
  for (Sample& s : run) {
    s.force.z() = sine(4.0, 30.0, 1e-9 * static_cast<double>(s.time_ns));
  }
  EXPECT_NEAR(*run_quality(run, kRate).oscillation_frequency, 30.0, 0.5);
}

TEST(RunQualityTest, WhatAHandDoesIsNoOscillation) {
  // 8 Hz with 6 N is slower than 10 Hz; 9 Hz of tremor with 0.3 N is too small.
  const RunQuality shaken =
      run_quality(run_of(5.0, [](double t) { return sine(3.0, 8.0, t); }), kRate);
  EXPECT_EQ(*shaken.oscillation, 0.0);
  const RunQuality tremor = run_quality(
      run_of(5.0, [](double t) { return sine(9.0, 0.3, t) + sine(0.3, 12.0, t); }), kRate);
  EXPECT_EQ(*tremor.oscillation, 0.0);
}

TEST(RunQualityTest, TicksThatAreMissingOrLateAreShares) {
  auto run = run_of(4.0, [](double) { return 3.0; });
  std::vector<Sample> half;
  for (std::size_t k = 0; k < run.size(); k += 2) {
    half.push_back(run[k]);
  }
  const RunQuality q = run_quality(half, kRate);
  EXPECT_NEAR(*q.missing_ticks, 0.5, 1e-9);
  EXPECT_NEAR(*q.late_ticks, 1.0, 1e-9);
  for (std::size_t k = 0; k < run.size(); k += 10) {
    run[k].time_ns += 600'000;
  }
  EXPECT_NEAR(*run_quality(run, kRate).late_ticks, 0.1, 1e-3);
}

TEST(RunQualityTest, AJumpOfThePositionIsASpeed) {
  auto run = run_of(2.0, [](double) { return 3.0; });
  for (std::size_t k = 1000; k < run.size(); ++k) {
    run[k].position.x() = 0.003;
  }
  EXPECT_NEAR(*run_quality(run, kRate).top_speed, 3.0, 1e-9);
}

TEST(RunQualityTest, OneSampleOrNoTimeTellsNothing) {
  auto run = run_of(0.001, [](double) { return 3.0; });
  run.resize(1);
  EXPECT_FALSE(run_quality(run, kRate).duration);
  run.push_back(run.front());
  EXPECT_FALSE(run_quality(run, kRate).saturation);
}

TEST(RunQualityTest, DroppedFramesAreThoseOfTheRun) {
  std::vector<record::FrameRow> frames;
  for (int k = 0; k < 100; ++k) {
    frames.push_back({k * 1000, 1, k < 50 ? 9 : k % 4 == 0 ? 1 : 0});
  }
  EXPECT_NEAR(*dropped_frames(frames, 60'000, 79'000), 5.0 / 25.0, 1e-12);
  EXPECT_FALSE(dropped_frames(frames, 200'000, 300'000));
  EXPECT_FALSE(dropped_frames({}, 0, 300'000));
}

}  // namespace
}  // namespace haptrial::analysis
