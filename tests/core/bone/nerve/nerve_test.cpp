// A nerve beside a drill, its electromyogram, and what a monitor makes of it. All simulated.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/bone/nerve/emg.h"
#include "core/bone/nerve/exposure.h"
#include "core/bone/nerve/monitor.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::nerve {
namespace {

constexpr double kDt = 1e-3;
constexpr std::size_t kTick = 8;  // samples

TEST(IrritatedNerveTest, BurstsComeAtTheRateOfTheLaw) {
  IrritatedNerve nerve({}, 1, "facial");
  Exposure e;
  e.distance = 0.002;
  e.force = 1.0;
  e.drilling = true;
  int bursts = 0;
  constexpr int kTicks = 1'000'000;
  for (int i = 0; i < kTicks; ++i) {
    bursts += nerve.step(e, kDt).burst ? 1 : 0;
  }
  const double expected = 1000.0 * std::exp(-1.0) * 2.0;
  EXPECT_NEAR(bursts, expected, 4.0 * std::sqrt(expected));
  e.drilling = false;
  for (int i = 0; i < 10'000; ++i) {
    EXPECT_FALSE(nerve.step(e, kDt).burst) << "a tool at rest irritates nobody";
  }
}

TEST(IrritatedNerveTest, HeatGathersToWhatTheLawSaysAndGoes) {
  IrritatedNerve nerve({}, 1, "facial");
  Exposure e;
  e.distance = 0.0;
  e.power = 2.0;
  e.drilling = true;
  for (int i = 0; i < 60'000; ++i) {
    nerve.step(e, kDt);
  }
  EXPECT_NEAR(nerve.warmth(), 1.0 * 2.0 * 8.0, 0.02) << "warming times power times cooling time";
  e.power = 0.0;
  for (int i = 0; i < 8000; ++i) {
    nerve.step(e, kDt);
  }
  EXPECT_NEAR(nerve.warmth(), 16.0 * std::exp(-1.0), 0.02);
}

TEST(IrritatedNerveTest, ContactDischargesAtOnceAndWithForceByATrain) {
  IrritatedNerve nerve({}, 1, "facial");
  Exposure e;
  e.distance = -1e-4;
  EXPECT_TRUE(nerve.step(e, kDt).burst);
  EXPECT_FALSE(nerve.step(e, kDt).burst) << "once for each contact";
  e.distance = 0.01;
  nerve.step(e, kDt);
  e.distance = 0.0;
  e.force = 2.0;
  const NerveEvents hit = nerve.step(e, kDt);
  EXPECT_TRUE(hit.train);
  EXPECT_EQ(hit.severity, 1.0);
}

TEST(EmgTest, BackgroundHasItsSizeAndNothingElse) {
  Emg emg({}, 1, "muscle");
  double square = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    for (const float v : emg.step({}, kTick)) {
      square += static_cast<double>(v) * v;
      sum += v;
    }
  }
  const double n = 100'000.0 * kTick;
  EXPECT_NEAR(std::sqrt(square / n), 4e-6, 0.04e-6);
  EXPECT_NEAR(sum / n, 0.0, 0.03e-6);
}

TEST(EmgTest, AnswersGrowWithTheCurrentAndShrinkWithTheDistance) {
  const StimulationParameters p;
  EXPECT_NEAR(answer_to(p.threshold, 0.0, p), 0.5 * p.most, 1e-9);
  EXPECT_LT(answer_to(0.05e-3, 0.0, p), 1e-3 * p.most);
  EXPECT_GT(answer_to(3e-3, 0.001, p), 0.99 * p.most);
  EXPECT_LT(answer_to(0.3e-3, 0.005, p), answer_to(0.3e-3, 0.0005, p));
}

/// Four muscles, one nerve with events of its own in each, under a drill that comes and goes.
struct Theatre {
  explicit Theatre(std::uint64_t seed, std::size_t count = 4) : common(seed, "drill") {
    for (std::size_t i = 0; i < count; ++i) {
      muscles.emplace_back(EmgParameters{}, seed, "muscle " + std::to_string(i));
    }
  }
  void tick(NerveMonitor& monitor, bool drilling, bool stimulus = false) {
    const auto noise = common.step(kTick);
    std::array<std::span<const float>, kMostChannels> all;
    for (std::size_t m = 0; m < muscles.size(); ++m) {
      all[m] = muscles[m].step({noise, drilling, false, stimulus}, kTick);
    }
    for (std::size_t s = 0; s < kTick; ++s) {
      std::array<float, kMostChannels> now{};
      for (std::size_t m = 0; m < muscles.size(); ++m) {
        now[m] = all[m][s];
      }
      monitor.look({now.data(), muscles.size()}, stimulus && s == 0);
    }
    for (const NerveEvent& e : monitor.ended()) {
      events.push_back(e);
    }
    monitor.forget_ended();
  }
  std::vector<Emg> muscles;
  CommonNoise common;
  std::vector<NerveEvent> events;
};

struct Score {
  int planted{0};
  int found{0};
  int false_alarms{0};
  double planted_train{0.0};  // [s]
  double found_train{0.0};
};

/// @param hours  of monitoring, with an event about every four seconds
Score score(double hours, std::uint64_t seed) {
  Theatre theatre(seed);
  NerveMonitor monitor({}, 4);
  RandomStream random(seed, "plan");
  std::vector<std::vector<SimulatedDischarge>> truth(4);
  Score s;
  const auto ticks = static_cast<int>(hours * 3600.0 / kDt);
  int next = 1000;
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick == next) {
      const std::size_t m = random.below(4);
      const bool train = random.uniform() < 0.3;
      const double severity = random.uniform(0.3, 1.0);
      Emg& muscle = theatre.muscles[m];
      truth[m].push_back(train ? muscle.train(severity) : muscle.burst(severity));
      const SimulatedDischarge& p = truth[m].back();
      s.planted_train += train ? static_cast<double>(p.last - p.first) / 8000.0 : 0.0;
      next = tick + 4000 + static_cast<int>(random.below(1000));
    }
    theatre.tick(monitor, (tick / 7000) % 2 == 0);
  }
  std::vector<std::vector<bool>> hit(4);
  for (std::size_t m = 0; m < 4; ++m) {
    hit[m].assign(truth[m].size(), false);
    s.planted += static_cast<int>(truth[m].size());
    s.found_train += monitor.channel(m).train_time;
  }
  for (const NerveEvent& e : theatre.events) {
    bool right = false;
    for (std::size_t k = 0; k < truth[e.channel].size(); ++k) {
      const SimulatedDischarge& p = truth[e.channel][k];
      if (!e.artefact && e.first <= p.last + 80 && e.last + 80 >= p.first) {
        hit[e.channel][k] = true;
        right = true;
      }
    }
    s.false_alarms += !right && !e.artefact ? 1 : 0;
  }
  for (const auto& channel : hit) {
    s.found += static_cast<int>(std::count(channel.begin(), channel.end(), true));
  }
  return s;
}

TEST(NerveMonitorTest, PlantedEventsAreFoundAndTheirTrainTimeCounted) {
  const Score s = score(0.5, 1);
  RecordProperty("planted", s.planted);
  RecordProperty("found", s.found);
  RecordProperty("false_alarms_in_half_an_hour", s.false_alarms);
  RecordProperty("train_time_planted", std::to_string(s.planted_train));
  RecordProperty("train_time_found", std::to_string(s.found_train));
  ASSERT_GT(s.planted, 300);
  EXPECT_GE(s.found, 0.95 * s.planted);
  EXPECT_LE(s.false_alarms, 2);
  EXPECT_NEAR(s.found_train / s.planted_train, 1.0, 0.1);
}

TEST(NerveMonitorTest, WhatCrossesInEveryChannelIsAnArtefact) {
  NerveMonitor monitor({}, 3);
  for (int i = 0; i < 20'000; ++i) {
    const float spike = i == 4000 ? 500e-6f : 0.0f;
    monitor.look(std::array{spike, spike, spike}, false);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(monitor.channel(c).events, 0u);
    EXPECT_EQ(monitor.channel(c).artefacts, 1u);
  }
}

TEST(NerveMonitorTest, AStimulusBlindsAndItsAnswerIsSeen) {
  Theatre theatre(3, 2);
  NerveMonitor monitor({}, 2);
  for (int tick = 0; tick < 1000; ++tick) {
    const bool pulse = tick == 200;
    if (pulse) {
      theatre.muscles[0].response(0.0062, 400e-6);
    }
    theatre.tick(monitor, false, pulse);
  }
  EXPECT_EQ(monitor.channel(0).events, 1u);
  EXPECT_EQ(monitor.channel(1).events, 0u);
  ASSERT_EQ(theatre.events.size(), 1u);
  EXPECT_NEAR(static_cast<double>(theatre.events[0].first) / 8000.0, 0.2 + 0.0062, 0.002);
}

TEST(NerveMonitorTest, TheThresholdRisesUnderTonesAndReturnsInQuiet) {
  NerveMonitor monitor({}, 1);
  const auto run = [&](double seconds, float size) {
    for (int i = 0; i < static_cast<int>(8000 * seconds); ++i) {
      monitor.look(std::array{i % 400 == 0 ? size : 0.0f}, false);
    }
  };
  run(9.9, 300e-6f);
  EXPECT_TRUE(monitor.channel(0).tone);
  EXPECT_DOUBLE_EQ(monitor.channel(0).threshold, 100e-6);
  run(0.2, 300e-6f);
  EXPECT_DOUBLE_EQ(monitor.channel(0).threshold, 150e-6);
  run(60.0, 900e-6f);
  EXPECT_DOUBLE_EQ(monitor.channel(0).threshold, 400e-6) << "and no higher";
  run(4.0, 0.0f);
  EXPECT_TRUE(monitor.channel(0).shown);
  run(2.0, 0.0f);
  EXPECT_FALSE(monitor.channel(0).shown);
  run(8.0, 0.0f);
  EXPECT_DOUBLE_EQ(monitor.channel(0).threshold, 400e-6);
  run(1.5, 0.0f);
  EXPECT_DOUBLE_EQ(monitor.channel(0).threshold, 100e-6);
}

TEST(NerveMonitorTest, TonesGoFromLowToHighByChannel) {
  const NerveMonitor monitor({}, 4);
  for (std::size_t c = 1; c < 4; ++c) {
    EXPECT_GT(monitor.channel(c).frequency, 1.1 * monitor.channel(c - 1).frequency);
  }
  EXPECT_THROW(NerveMonitor({}, 0), std::invalid_argument);
  EXPECT_THROW(NerveMonitor({}, 9), std::invalid_argument);
}

TEST(NerveMonitorTest, ATickDoesNotAllocate) {
  Theatre theatre(5, 4);
  theatre.events.reserve(1000);
  NerveMonitor monitor({}, 4);
  IrritatedNerve nerve({}, 1, "facial");
  Exposure e;
  e.distance = 0.0;
  e.drilling = true;
  e.force = 2.0;
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 5000; ++tick) {
    const NerveEvents now = nerve.step(e, kDt);
    if (now.burst) {
      theatre.muscles[0].burst(now.severity);
    }
    if (now.train) {
      theatre.muscles[1].train(now.severity);
    }
    theatre.tick(monitor, true);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::nerve
