#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "core/base/random.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

using test::example_info;
using test::hand_motion;
using test::on_file;
using test::same;
using test::TemporaryFolder;

void expect_on_file(const SessionReader& reader, const std::vector<Sample>& given) {
  ASSERT_EQ(reader.sample_count(), given.size());
  const std::vector<Sample> back = reader.samples(0, given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    ASSERT_TRUE(same(back[i], on_file(given[i]))) << "row " << i;
  }
}

TEST(SessionFileTest, SamplesComeBackOnTheirGrids) {
  const TemporaryFolder folder;
  // Around the chunk length: none, one, a chunk less one, a chunk, one more, several.
  for (const std::size_t count : {0, 1, 4095, 4096, 4097, 10000}) {
    const std::vector<Sample> samples = hand_motion(count, count);
    const auto file = folder / (std::to_string(count) + ".h5");
    SessionWriter writer(file, example_info());
    writer.append(samples);
    writer.close();
    expect_on_file(SessionReader(file), samples);
  }
}

TEST(SessionFileTest, ExtremeValuesComeBack) {
  const TemporaryFolder folder;
  std::vector<Sample> samples(3);
  samples[0].sequence = std::numeric_limits<std::uint64_t>::max();
  samples[0].time_ns = std::numeric_limits<std::int64_t>::min();
  samples[0].pass = std::numeric_limits<std::int32_t>::min();
  samples[0].stage = Stage::kReturn;
  samples[0].position = {1e30, -1e30, 15.999999};
  samples[0].force = {std::numeric_limits<double>::infinity(), -2048.0, 1e-300};
  samples[1].applied_force = std::numeric_limits<double>::quiet_NaN();
  samples[1].target_force = -0x1p-14;  // halfway between two steps: to the even one, 0
  samples[2].target_force = 3 * 0x1p-14;
  samples[2].saturated = true;
  SessionWriter writer(folder / "a.h5", example_info());
  writer.append(samples);
  writer.close();
  const std::vector<Sample> back = SessionReader(folder / "a.h5").samples(0, 3);
  EXPECT_TRUE(same(back[0], on_file(samples[0])));
  EXPECT_EQ(back[0].position.x(), static_cast<double>(1e30f));
  EXPECT_TRUE(std::isinf(back[0].force.x()));
  EXPECT_TRUE(std::isnan(back[1].applied_force));
  EXPECT_EQ(back[1].target_force, 0.0);
  EXPECT_EQ(back[2].target_force, 0x1p-12);
  EXPECT_TRUE(back[2].saturated);
}

TEST(SessionFileTest, InfoComesBackWithALongDefinition) {
  const TemporaryFolder folder;
  SessionInfo info = example_info();
  for (int i = 0; i < 20000; ++i) {
    info.definition += "# Zeile ü " + std::to_string(i) + "\n";
  }
  ASSERT_GT(info.definition.size(), 200000u);
  info.subject = "";
  info.simulated = false;
  info.rate = 1234.5;
  SessionWriter(folder / "a.h5", info).close();
  const SessionReader reader(folder / "a.h5");
  const SessionInfo& back = reader.info();
  EXPECT_EQ(back.program_version, info.program_version);
  EXPECT_EQ(back.program_commit, info.program_commit);
  EXPECT_EQ(back.definition, info.definition);
  EXPECT_EQ(back.definition_name, info.definition_name);
  EXPECT_EQ(back.subject, info.subject);
  EXPECT_EQ(back.seed, info.seed);
  EXPECT_EQ(back.device, info.device);
  EXPECT_EQ(back.device_max_force, info.device_max_force);
  EXPECT_EQ(back.device_workspace_radius, info.device_workspace_radius);
  EXPECT_EQ(back.clock, info.clock);
  EXPECT_EQ(back.rate, info.rate);
  EXPECT_EQ(back.start_utc, info.start_utc);
  EXPECT_EQ(back.simulated, info.simulated);
}

TEST(SessionFileTest, TrialsAndStimuliAndTimingComeBack) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", example_info());
  std::vector<StimulusRow> stimuli;
  std::vector<TimingRow> timing;
  constexpr std::int32_t kPasses = 150;  // more than a chunk of /trials
  for (std::int32_t i = 0; i < kPasses; ++i) {
    const auto big = static_cast<std::uint64_t>(i) << 40;
    writer.add_pass({i, std::string(static_cast<std::size_t>(i % 65), 'c'),
                     i % 2 == 0 ? Phase::kTraining : Phase::kTest, i + 1, i + 2, big, big + 1,
                     big + 2, i % 3 == 0 ? PassStatus::kAborted : PassStatus::kCompleted});
  }
  for (std::int32_t i = 0; i < 9000; ++i) {
    stimuli.push_back({i / 100, 0.001 * i, {0.1 * i, -0.1 * i, 1.0 / (i + 1)}, std::sin(i)});
  }
  for (std::int64_t i = 0; i < 600; ++i) {
    timing.push_back({i * 1000, i * 1000 + 1000, static_cast<std::uint64_t>(i), 7, 9});
  }
  writer.add_stimulus(stimuli);
  writer.set_timing(timing, {9, 8, 7});
  writer.close();

  const SessionReader reader(folder / "a.h5");
  const std::vector<PassRow> passes = reader.passes();
  ASSERT_EQ(passes.size(), static_cast<std::size_t>(kPasses));
  for (std::int32_t i = 0; i < kPasses; ++i) {
    const PassRow& pass = passes[static_cast<std::size_t>(i)];
    EXPECT_EQ(pass.trial, i);
    EXPECT_EQ(pass.condition.size(), static_cast<std::size_t>(i % 65));
    EXPECT_EQ(pass.phase == Phase::kTraining, i % 2 == 0);
    EXPECT_EQ(pass.block, i + 1);
    EXPECT_EQ(pass.repetition, i + 2);
    EXPECT_EQ(pass.stimulus_seed, static_cast<std::uint64_t>(i) << 40);
    EXPECT_EQ(pass.first_sample, pass.stimulus_seed + 1);
    EXPECT_EQ(pass.last_sample, pass.stimulus_seed + 2);
    EXPECT_EQ(pass.status == PassStatus::kAborted, i % 3 == 0);
  }
  const std::vector<StimulusRow> stimuli_back = reader.stimuli();
  ASSERT_EQ(stimuli_back.size(), stimuli.size());
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    EXPECT_EQ(stimuli_back[i].block, stimuli[i].block);
    EXPECT_EQ(stimuli_back[i].time, stimuli[i].time);
    EXPECT_EQ(stimuli_back[i].position, stimuli[i].position);
    EXPECT_EQ(stimuli_back[i].force, stimuli[i].force);
  }
  const std::vector<TimingRow> timing_back = reader.timing();
  ASSERT_EQ(timing_back.size(), timing.size());
  EXPECT_EQ(timing_back[599].bin_low_ns, 599000);
  EXPECT_EQ(timing_back[599].bin_high_ns, 600000);
  EXPECT_EQ(timing_back[599].period_count, 599u);
  EXPECT_EQ(timing_back[599].lateness_count, 7u);
  EXPECT_EQ(timing_back[599].compute_count, 9u);
  ASSERT_TRUE(reader.timing_summary().has_value());
  EXPECT_EQ(reader.timing_summary()->ticks, 9u);
  EXPECT_EQ(reader.timing_summary()->overruns, 8u);
  EXPECT_EQ(reader.timing_summary()->dropped, 7u);
}

TEST(SessionFileTest, EventTextsOfAnyLengthComeBack) {
  const TemporaryFolder folder;
  std::vector<EventRow> events;
  // Lengths around one and two columns of 256 bytes; characters of one to four bytes at the cuts.
  for (const char* letter : {"x", "ü", "€", "🖐"}) {
    for (const std::size_t count : {0, 1, 63, 64, 65, 127, 128, 129, 255, 256, 257, 513}) {
      EventRow event{static_cast<std::int64_t>(count), "kind", "a"};
      for (std::size_t i = 0; i < count; ++i) {
        event.text += letter;
      }
      events.push_back(event);
    }
  }
  events.push_back({1, std::string(32, 'k'), ""});
  events.push_back({2, "not_utf8", std::string(1000, '\x80')});
  SessionWriter writer(folder / "a.h5", example_info());
  for (const EventRow& event : events) {
    writer.add_event(event);
  }
  writer.close();
  const std::vector<EventRow> back = SessionReader(folder / "a.h5").events();
  ASSERT_EQ(back.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(back[i].time_ns, events[i].time_ns);
    EXPECT_EQ(back[i].kind, events[i].kind);
    EXPECT_EQ(back[i].text, events[i].text);
  }
}

TEST(SessionFileTest, TextsThatDoNotFitAreRefusedAndLeaveNoRow) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", example_info());
  PassRow pass;
  pass.condition = std::string(65, 'c');
  EXPECT_THROW(writer.add_pass(pass), std::invalid_argument);
  EXPECT_THROW(writer.add_event({0, std::string(33, 'k'), ""}), std::invalid_argument);
  EXPECT_THROW(writer.add_event({0, "k", std::string("a\0b", 3)}), std::invalid_argument);
  // The bad byte comes in the second row of the event: its first must not stay either.
  EXPECT_THROW(writer.add_event({0, "k", std::string(300, 'a') + std::string("\0", 1)}),
               std::invalid_argument);
  writer.add_event({1, "good", "text"});
  writer.close();
  const SessionReader reader(folder / "a.h5");
  EXPECT_TRUE(reader.passes().empty());
  ASSERT_EQ(reader.events().size(), 1u);
  EXPECT_EQ(reader.events()[0].kind, "good");
}

TEST(SessionFileTest, BatchesAndFlushesDoNotChangeTheRows) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(30000, 5);
  RandomStream random(5, "batches");
  SessionWriter writer(folder / "a.h5", example_info());
  for (std::size_t at = 0; at < samples.size();) {
    const std::size_t count = std::min<std::size_t>(random.below(2000), samples.size() - at);
    writer.append(std::span(samples).subspan(at, count));
    if (random.below(3) == 0) {
      writer.flush();
    }
    at += count;
  }
  writer.close();
  expect_on_file(SessionReader(folder / "a.h5"), samples);
}

TEST(SessionFileTest, PiecesAndColumnsAgreeWithTheWhole) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(20000, 6);
  SessionWriter writer(folder / "a.h5", example_info());
  writer.append(samples);
  writer.close();
  const SessionReader reader(folder / "a.h5");
  RandomStream random(6, "pieces");
  for (int repeat = 0; repeat < 30; ++repeat) {
    const std::uint64_t first = random.below(samples.size() + 1);
    const std::uint64_t count = random.below(samples.size() - first + 1);
    const std::vector<Sample> piece = reader.samples(first, count);
    const SampleColumns columns = reader.columns(first, count);
    ASSERT_EQ(piece.size(), count);
    ASSERT_EQ(columns.time_ns.size(), count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const Sample expected = on_file(samples[first + i]);
      const auto column = static_cast<Eigen::Index>(i);
      ASSERT_TRUE(same(piece[i], expected));
      ASSERT_EQ(columns.time_ns[i], expected.time_ns);
      ASSERT_EQ(columns.position.col(column), expected.position);
      ASSERT_EQ(columns.applied_force[column], expected.applied_force);
      ASSERT_EQ(columns.target_force[column], expected.target_force);
    }
  }
  EXPECT_THROW(reader.samples(20000, 1), std::invalid_argument);
  EXPECT_THROW(reader.samples(0, 20001), std::invalid_argument);
  EXPECT_THROW(reader.columns(1, std::numeric_limits<std::uint64_t>::max()), std::invalid_argument);
}

TEST(SessionFileTest, WritersAndReadersWorkInThreadsAtOnce) {
  const TemporaryFolder folder;
  constexpr std::size_t kThreads = 4;
  std::vector<std::vector<Sample>> samples;
  for (std::size_t i = 0; i < kThreads; ++i) {
    samples.push_back(hand_motion(50000, 100 + i));
  }
  const auto file = [&](std::size_t i) { return folder / (std::to_string(i) + ".h5"); };
  std::vector<std::size_t> wrong(kThreads, 1);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < kThreads; ++i) {
      threads.emplace_back([&, i] {
        SessionWriter writer(file(i), example_info());
        for (std::size_t at = 0; at < 50000; at += 500) {
          writer.append(std::span(samples[i]).subspan(at, 500));
          if (at % 5000 == 0) {
            writer.flush();
          }
        }
        writer.close();
        const std::vector<Sample> back = SessionReader(file(i)).samples(0, 50000);
        wrong[i] = 0;
        for (std::size_t k = 0; k < 50000; ++k) {
          wrong[i] += !same(back[k], on_file(samples[i][k]));
        }
      });
    }
  }
  for (std::size_t i = 0; i < kThreads; ++i) {
    EXPECT_EQ(wrong[i], 0u) << "thread " << i;
  }
  // One reader, several threads.
  const SessionReader reader(file(0));
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      const std::vector<Sample> back = reader.samples(i * 1000, 40000);
      for (std::size_t k = 0; k < back.size(); ++k) {
        wrong[i] += !same(back[k], on_file(samples[0][i * 1000 + k]));
      }
    });
  }
  threads.clear();
  for (std::size_t i = 0; i < kThreads; ++i) {
    EXPECT_EQ(wrong[i], 0u) << "thread " << i;
  }
}

}  // namespace
}  // namespace haptrial::record
