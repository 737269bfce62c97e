// Electromyograms, events and sound beside a servo thread. All simulated.

#include "core/bone/nerve/nerve_beside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>
#include <vector>

#include "core/sound/drill_sound.h"
#include "core/sound/spectrum_table.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::nerve {
namespace {

using Kind = record::NerveEventRow::Kind;

NerveSetup two_nerves() {
  NerveSetup setup;
  setup.nerves = {{"facial nerve", {}, 0.0, {"oculi", "oris"}}, {"drawn", {}, 0.0, {"drawn"}}};
  return setup;
}

MakeNerveSimulation maker() {
  return [](std::uint64_t first) {
    return std::make_unique<NerveSimulation>(two_nerves(), 1000.0, 7 + first);
  };
}

/// Bursts and trains now and then, a drill that comes and goes, a probe towards the end.
std::vector<NerveTick> plan(std::uint64_t ticks) {
  std::vector<NerveTick> all;
  RandomStream random(5, "plan");
  for (std::uint64_t i = 0; i < ticks; ++i) {
    NerveTick tick;
    tick.sequence = 100 + i;
    tick.drilling = (i / 3000) % 2 == 0;
    auto& nerve = tick.nerves[random.below(2)];
    nerve.distance = 1e-3f;
    nerve.burst = i % 2500 == 700;
    nerve.train = i % 7500 == 2000;
    nerve.severity = static_cast<float>(random.uniform(0.4, 1.0));
    tick.current = i % 400 == 0 && i + 2000 > ticks ? 1e-3f : 0.0f;
    all.push_back(tick);
  }
  return all;
}

record::NerveRows rows_of(NerveBeside& beside, const std::vector<NerveTick>& ticks) {
  record::NerveRows rows;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    beside.after_tick(ticks[i]);
    if (i % 1000 == 999) {
      beside.settle();
      rows.append(beside.take());
    }
  }
  beside.settle();
  rows.append(beside.take());
  return rows;
}

TEST(NerveBesideTest, AThreadMakesTheSameRows) {
  const std::vector<NerveTick> ticks = plan(12'000);
  SteppedNerves stepped(maker());
  ThreadedNerves threaded(maker(), 1000.0, {});
  const record::NerveRows a = rows_of(stepped, ticks);
  const record::NerveRows b = rows_of(threaded, ticks);
  EXPECT_EQ(threaded.dropped(), 0u);
  ASSERT_EQ(a.emg.size(), 12'000u * 8);
  ASSERT_EQ(b.emg.size(), a.emg.size());
  for (std::size_t i = 0; i < a.emg.size(); ++i) {
    ASSERT_EQ(a.emg[i].channels, b.emg[i].channels) << i;
    ASSERT_EQ(a.emg[i].sequence, 100 + i / 8);
    ASSERT_EQ(b.emg[i].sample, i % 8);
  }
  ASSERT_GT(a.events.size(), 5u);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].begin, b.events[i].begin);
    EXPECT_EQ(a.events[i].peak, b.events[i].peak);
  }
  ASSERT_EQ(a.discharges.size(), b.discharges.size());
}

TEST(NerveBesideTest, PlantedEventsAreFoundByKind) {
  SteppedNerves beside(maker());
  const record::NerveRows rows = rows_of(beside, plan(40'000));
  int planted = 0, found = 0, right_kind = 0, alarms = 0;
  for (const auto& d : rows.discharges) {
    if (d.kind == Kind::kArtefact) {
      continue;
    }
    ++planted;
    bool hit = false, kind = false;
    for (const auto& e : rows.events) {
      const bool meets = e.channel == d.channel && e.kind != Kind::kArtefact &&
                         e.begin <= d.end + 10 && e.end + 10 >= d.sequence;
      hit = hit || meets;
      kind = kind || (meets && e.kind == d.kind);
    }
    found += hit ? 1 : 0;
    right_kind += kind ? 1 : 0;
  }
  for (const auto& e : rows.events) {
    bool right = e.kind == Kind::kArtefact;
    for (const auto& d : rows.discharges) {
      right =
          right || (e.channel == d.channel && e.begin <= d.end + 10 && e.end + 10 >= d.sequence);
    }
    alarms += right ? 0 : 1;
  }
  EXPECT_GT(planted, 20);
  EXPECT_GE(found, 0.95 * planted);
  EXPECT_GE(right_kind, 0.9 * planted);
  EXPECT_LE(alarms, 1);
  int artefacts = 0;
  for (const auto& e : rows.events) {
    artefacts += e.kind == Kind::kArtefact ? 1 : 0;
  }
  EXPECT_GT(artefacts, 10) << "switching the drill reaches every channel";
}

TEST(NerveBesideTest, APushDoesNotAllocateAndFullLogsAreCounted) {
  std::atomic<bool> all_pushed{false};
  ThreadedNerves beside(
      [&](std::uint64_t) -> std::unique_ptr<NerveSimulation> {
        all_pushed.wait(false);
        return std::make_unique<NerveSimulation>(two_nerves(), 1000.0, 1);
      },
      1000.0, {});
  NerveTick tick;
  std::uint64_t pushed = 0;
  {
    const test::AllocationGuard guard;
    for (; pushed < 10'000; ++pushed) {
      tick.sequence = pushed;
      beside.after_tick(tick);
    }
    EXPECT_EQ(guard.count(), 0u);
  }
  all_pushed = true;
  all_pushed.notify_all();
  beside.settle();
  EXPECT_GT(beside.dropped(), 0u) << "8,192 find room while nobody takes them";
  EXPECT_EQ(beside.take().emg.size(), (pushed - beside.dropped()) * 8);
}

TEST(NerveBesideTest, ATechnicianMutesAndSetsThresholds) {
  const auto buffer = std::make_shared<MonitorBuffer>();
  ThreadedNerves beside(maker(), 1000.0, {buffer, nullptr});
  const std::vector<NerveTick> ticks = plan(4000);
  for (std::size_t i = 0; i < 2000; ++i) {
    beside.after_tick(ticks[i]);
  }
  beside.settle();
  using What = MonitorOrder::What;
  buffer->ask({.what = What::kMute, .channel = 0, .muted = true});
  buffer->ask({.what = What::kThreshold, .channel = 1, .threshold = 250e-6});
  buffer->ask({.what = What::kMute, .channel = 99, .muted = true});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  for (std::size_t i = 2000; i < 4000; ++i) {
    beside.after_tick(ticks[i]);
  }
  beside.settle();
  const MonitorBuffer::View view = buffer->since(0, 0);
  ASSERT_EQ(view.channels.size(), 3u);
  EXPECT_TRUE(view.channels[0].muted);
  EXPECT_FALSE(view.channels[1].muted);
  EXPECT_DOUBLE_EQ(view.channels[1].threshold, 250e-6);
  EXPECT_EQ(view.channels[2].name, "drawn");
  EXPECT_EQ(view.columns.size(), 4000u / 5 * 3);
  EXPECT_TRUE(buffer->since(view.next_column, view.next_event).columns.empty());
  std::size_t technician = 0;
  for (const auto& row : beside.take().thresholds) {
    technician += row.cause == record::NerveThresholdRow::Cause::kTechnician ? 1 : 0;
  }
  EXPECT_EQ(technician, 2u);
}

/// Power of a sound at a frequency, by Goertzel's sum under a Hann window.
double level(const std::vector<float>& sound, double frequency) {
  const auto n = static_cast<double>(sound.size());
  double re = 0.0, im = 0.0;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double t = static_cast<double>(i);
    const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * t / n);
    const double phase = 2.0 * std::numbers::pi * frequency * t / 48'000.0;
    re += w * static_cast<double>(sound[i]) * std::cos(phase);
    im += w * static_cast<double>(sound[i]) * std::sin(phase);
  }
  return 4.0 * std::hypot(re, im) / n;  // amplitude of a line
}

std::vector<float> voice_of(const VoiceTick& tick, std::size_t parts, sound::DrillSound* drill) {
  NerveVoice voice(8000.0);
  std::vector<float> heard;
  for (std::size_t part = 0; part < parts; ++part) {
    for (int ms = 0; ms < 5; ++ms) {
      voice.push(tick);
    }
    std::array<float, 240> samples{};
    for (float& sample : samples) {
      sample = drill != nullptr ? drill->next() : 0.0f;
    }
    voice.mix(samples);
    if (part >= parts / 2) {
      heard.insert(heard.end(), samples.begin(), samples.end());
    }
  }
  return heard;
}

TEST(NerveVoiceTest, EachChannelHasATone) {
  const NerveMonitor monitor({}, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    VoiceTick tick;
    tick.count = 8;
    const double frequency = monitor.channel(i).frequency;
    tick.tones[i] = static_cast<float>(frequency);
    const std::vector<float> heard = voice_of(tick, 200, nullptr);
    EXPECT_NEAR(level(heard, frequency), 0.12, 0.006) << "as loud as it says";
    for (std::size_t other = 0; other < 4; ++other) {
      if (other != i) {
        EXPECT_LT(level(heard, monitor.channel(other).frequency), 1e-3);
      }
    }
  }
}

TEST(NerveVoiceTest, TheRawElectromyogramIsHeardBelowTheThreshold) {
  NerveVoice voice(8000.0);
  std::vector<float> heard;
  double phase = 0.0;
  for (int part = 0; part < 400; ++part) {
    for (int ms = 0; ms < 5; ++ms) {
      VoiceTick tick;
      tick.count = 8;
      for (std::size_t s = 0; s < 8; ++s, phase += 250.0 / 8000.0) {
        tick.raw[s] = static_cast<float>(50e-6 * std::sin(2.0 * std::numbers::pi * phase));
      }
      voice.push(tick);
    }
    std::array<float, 240> samples{};
    voice.mix(samples);
    if (part >= 200) {
      heard.insert(heard.end(), samples.begin(), samples.end());
    }
  }
  EXPECT_NEAR(level(heard, 250.0), 0.05, 0.004) << "50 uV are a twentieth of full scale";
}

TEST(NerveVoiceTest, TheDrillIsHeardBesideIt) {
  const auto drill_alone = [](sound::DrillSound& drill) {
    std::vector<float> heard;
    for (int i = 0; i < 200 * 240; ++i) {
      const float sample = drill.next();
      if (i >= 100 * 240) {
        heard.push_back(sample);
      }
    }
    return heard;
  };
  sound::DrillState on;
  on.speed = 1.0;
  sound::DrillSound a(sound::default_sound(), {}, 1);
  sound::DrillSound b(sound::default_sound(), {}, 1);
  a.set(on);
  b.set(on);
  VoiceTick tick;
  tick.count = 8;
  tick.tones[0] = 400.0f;
  const std::vector<float> both = voice_of(tick, 200, &a);
  const std::vector<float> alone = drill_alone(b);
  EXPECT_NEAR(level(both, 400.0) - level(alone, 400.0), 0.12, 0.02);
  double loudest = 0.0, at = 0.0;
  for (double f = 500.0; f < 6000.0; f += 5.0) {
    if (const double l = level(alone, f); l > loudest) {
      loudest = l;
      at = f;
    }
  }
  ASSERT_GT(loudest, 0.0);
  EXPECT_NEAR(level(both, at), loudest, 0.1 * loudest) << "the drill's line is as it was";
}

TEST(NerveVoiceTest, MixingDoesNotAllocateAndStaysInRange) {
  NerveVoice voice(8000.0);
  VoiceTick tick;
  tick.count = 8;
  tick.raw.fill(1e-3f);
  tick.tones.fill(440.0f);
  std::array<float, 240> samples{};
  samples.fill(0.9f);
  const test::AllocationGuard guard;
  for (int part = 0; part < 100; ++part) {
    for (int ms = 0; ms < 5; ++ms) {
      voice.push(tick);
    }
    voice.mix(samples);
    for (const float sample : samples) {
      ASSERT_LE(std::abs(sample), 1.0f);
    }
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::nerve
