// A live session whose power is cut: after every write, and with what was not synced lost, kept or
// reordered.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recover.h"
#include "core/record/recovery/session_resume.h"
#include "tests/core/record/disk_tap.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::power_cut_test {
namespace {

namespace fs = std::filesystem;
using test::DiskStep;
using test::DiskTap;
using test::TemporaryFolder;

constexpr std::uint64_t kPasses = 8;
constexpr std::uint64_t kPass = 1800;  // ticks
constexpr std::uint64_t kPause = 400;  // ticks between passes
constexpr std::uint64_t kCycle = kPass + kPause;
constexpr std::uint64_t kRows = kPasses * kCycle;
constexpr std::size_t kPage = 4096;

bool all_of_them() { return std::getenv("HAPTRIAL_POWER_CUTS") != nullptr; }

/// Rows that were given to the writer before a sync that ended.
struct Synced {
  std::uint64_t rows{0}, tool{0}, passes{0}, events{0}, begun{0}, frames{0};
};

std::vector<Sample> session_samples() {
  std::vector<Sample> samples = test::hand_motion(kRows, 8);
  for (Sample& sample : samples) {
    const std::uint64_t at = sample.sequence % kCycle;
    sample.pass = at < kPass ? static_cast<std::int32_t>(sample.sequence / kCycle) : -1;
  }
  return samples;
}

PassRow pass_row(std::uint64_t pass) {
  return {static_cast<std::int32_t>(pass / 2 + 1),
          "haptic",
          pass % 2 == 0 ? Phase::kTraining : Phase::kTest,
          1,
          1,
          7,
          pass * kCycle,
          pass * kCycle + kPass - 1};
}

/// A live session as it came to the disk.
struct Recording {
  std::vector<Sample> samples = session_samples();
  bool drills;
  std::vector<DiskStep> steps;
  std::vector<Synced> marks;

  explicit Recording(bool drilling) : drills(drilling) {
    const TemporaryFolder folder;
    SessionInfo info = test::example_info();
    info.clock = "real";
    const std::vector<BoneRecord> bones{test::small_bone()};
    SessionWriter writer =
        drills ? SessionWriter(folder / "a.h5", info, drilling_tables(), rows_of(bones))
               : SessionWriter(folder / "a.h5", info);
    const std::string created = file_text(folder / "a.h5.partial");
    DiskTap::start((folder / "a.h5.partial").string());
    write(writer);
    std::vector<DiskStep> live = DiskTap::stop();
    // The file was synced when it was created.
    steps = {{DiskStep::kWrite, 0, created},
             {DiskStep::kSyncBegins, 0, ""},
             {DiskStep::kSyncEnds, 0, ""}};
    steps.insert(steps.end(), live.begin(), live.end());
  }

  void write(SessionWriter& writer) {
    const std::vector<ToolRow> tool = test::tool_motion(kRows, 4);
    Synced so_far;
    const auto mark = [&] {
      DiskTap::mark(marks.size());
      marks.push_back(so_far);
    };
    for (std::uint64_t at = 0; at < kRows; at += 20) {
      if (at % kCycle == 0) {
        writer.begin_pass({static_cast<std::int32_t>(at / kCycle), pass_row(at / kCycle)});
        ++so_far.begun;
      }
      if (drills) {
        writer.add(std::span(tool).subspan(at, 20));
      }
      if (drills) {
        const RemovalRow removal{at, 0, {1, 2, static_cast<std::int32_t>(at)}, 1, false, 0.5, 0.1};
        writer.add(std::span(&removal, 1));
      }
      writer.append(std::span(samples).subspan(at, 20));
      const std::uint64_t done = at + 20;
      so_far.rows = done;
      if (done % 500 == 0) {
        writer.add_event({static_cast<std::int64_t>(done) * 1000000, "note", "half a second"});
        ++so_far.events;
        writer.add_frames(std::vector<FrameRow>{{static_cast<std::int64_t>(done) * 1000000, 2, 0}});
        ++so_far.frames;
        writer.flush();
      }
      if (done % kCycle == kPass) {
        writer.add_pass(pass_row(done / kCycle));
        ++so_far.passes;
        writer.sync();
        mark();
      }
    }
  }
};

/// Bytes with a length, as a file system has them.
struct Image {
  std::string bytes;
  void apply(const DiskStep& step) {
    if (step.kind == DiskStep::kTruncate) {
      bytes.resize(step.offset);
    }
    if (step.kind != DiskStep::kWrite) {
      return;
    }
    bytes.resize(std::max<std::size_t>(bytes.size(), step.offset + step.bytes.size()));
    bytes.replace(step.offset, step.bytes.size(), step.bytes);
  }
};

Synced synced_before(const Recording& recording, std::size_t end) {
  Synced synced;
  for (std::size_t i = 0; i < end; ++i) {
    if (recording.steps[i].kind == DiskStep::kMark) {
      synced = recording.marks[recording.steps[i].offset];
    }
  }
  return synced;
}

/// The file when everything had come to the disk in order up to the step `end`.
std::string in_order(const Recording& recording, std::size_t end) {
  Image image;
  for (std::size_t i = 0; i < end; ++i) {
    image.apply(recording.steps[i]);
  }
  return image.bytes;
}

/// The file when the power went at the step `end`: what was written before the last whole sync
/// began is there; of the rest each page is as it was after any of its writes, or before them all,
/// and the length is one that the file had.
std::string reordered(const Recording& recording, std::size_t end, RandomStream& random) {
  std::size_t begun = 0, safe = 0;
  for (std::size_t i = 0; i < end; ++i) {
    if (recording.steps[i].kind == DiskStep::kSyncBegins) {
      begun = i;
    }
    if (recording.steps[i].kind == DiskStep::kSyncEnds) {
      safe = begun;
    }
  }
  Image image;
  for (std::size_t i = 0; i < safe; ++i) {
    image.apply(recording.steps[i]);
  }
  std::map<std::size_t, std::vector<std::string>> versions;  // of each page
  std::vector<std::size_t> lengths{image.bytes.size()};
  Image later = image;
  for (std::size_t i = safe; i < end; ++i) {
    const DiskStep& step = recording.steps[i];
    if (step.kind != DiskStep::kWrite || step.bytes.empty()) {
      continue;
    }
    const std::size_t first = step.offset / kPage;
    const std::size_t last = (step.offset + step.bytes.size() - 1) / kPage;
    for (std::size_t page = first; page <= last; ++page) {
      if (!versions.contains(page)) {
        versions[page] = {image.bytes.size() > page * kPage
                              ? image.bytes.substr(page * kPage, kPage)
                              : std::string()};
      }
    }
    later.apply(step);
    lengths.push_back(later.bytes.size());
    for (std::size_t page = first; page <= last; ++page) {
      versions[page].push_back(later.bytes.substr(page * kPage, kPage));
    }
  }
  const std::size_t length = lengths[random.below(lengths.size())];
  image.bytes.resize(std::max(length, image.bytes.size()));
  for (auto& [page, kept] : versions) {
    std::string bytes = kept[random.below(kept.size())];
    bytes.resize(kPage);
    if (page * kPage >= image.bytes.size()) {
      continue;
    }
    const std::size_t fits = std::min(kPage, image.bytes.size() - page * kPage);
    image.bytes.replace(page * kPage, fits, bytes.substr(0, fits));
  }
  return image.bytes;
}

struct Tally {
  int cuts{0}, as_it_was{0}, repaired{0}, refused{0};
  std::uint64_t synced{0}, by_resume{0}, by_recover{0};
  std::uint64_t passes_synced{0}, passes_by_resume{0}, passes_by_recover{0};
  void print(const char* what) const {
    std::printf(
        "%s: %d files; resume went on with %d as they were, repaired %d, refused %d; rows synced "
        "%llu, kept by resume %llu, by recover %llu; passes synced %llu, by resume %llu, by "
        "recover %llu\n",
        what, cuts, as_it_was, repaired, refused, ull(synced), ull(by_resume), ull(by_recover),
        ull(passes_synced), ull(passes_by_resume), ull(passes_by_recover));
  }
  static unsigned long long ull(std::uint64_t value) { return value; }
};

/// Every row is one that was recorded, and those that were synced are there.
void check_rows(const SessionReader& reader, const Recording& recording, const Synced& synced) {
  const std::vector<Sample> rows = reader.samples(0, reader.sample_count());
  ASSERT_GE(rows.size(), synced.rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_LT(rows[i].sequence, kRows);
    if (i < synced.rows) {
      ASSERT_EQ(rows[i].sequence, i) << "a synced row is missing";
    }
    ASSERT_TRUE(test::same(rows[i], test::on_file(recording.samples[rows[i].sequence])))
        << "row " << i;
  }
  const std::vector<PassRow> passes = reader.passes();
  ASSERT_GE(passes.size(), synced.passes);
  for (std::size_t i = 0; i < synced.passes; ++i) {
    ASSERT_EQ(passes[i].first_sample, pass_row(i).first_sample);
    ASSERT_EQ(passes[i].last_sample, pass_row(i).last_sample);
    ASSERT_EQ(passes[i].phase, pass_row(i).phase);
    ASSERT_EQ(passes[i].status, PassStatus::kCompleted);
  }
  ASSERT_GE(reader.events().size(), synced.events);
  ASSERT_GE(reader.frames().size(), synced.frames);
  ASSERT_GE(reader.begun().size(), synced.begun);
  if (recording.drills) {
    ASSERT_GE(reader.count<ToolRow>(), synced.rows);
    ASSERT_GE(reader.count<RemovalRow>(), synced.rows / 20);
    ASSERT_EQ(recorded_bones(reader).size(), 1u);
    ASSERT_EQ(recorded_bones(reader)[0].runs.size(), 2u);
  }
}

/// A resumed session to its end: nothing but time is missing.
void go_on(SessionWriter& writer, const Resumed& found, bool drills) {
  for (const OpenPass& open : found.open_passes) {
    writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, open.first_sample, open.last_sample,
                     PassStatus::kAborted});
  }
  std::vector<Sample> more(500);
  for (std::size_t i = 0; i < more.size(); ++i) {
    more[i].sequence = found.next_sequence + i;
    more[i].time_ns = found.last_time_ns + 1 + static_cast<std::int64_t>(i) * 1000000;
  }
  if (drills) {
    std::vector<ToolRow> tool = test::tool_motion(more.size(), 5);
    for (std::size_t i = 0; i < tool.size(); ++i) {
      tool[i].sequence = more[i].sequence;
    }
    writer.add(std::span<const ToolRow>(tool));
  }
  writer.append(more);
  writer.set_timing({}, {more.size(), 0, 0});
  writer.close();
}

void try_file(const Recording& recording, const std::string& bytes, const Synced& synced,
              Tally& tally) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.h5";
  const fs::path partial = folder / "a.h5.partial";
  std::ofstream(partial, std::ios::binary) << bytes;
  ++tally.cuts;
  tally.synced += synced.rows;
  tally.passes_synced += synced.passes;

  const Recovery recovery =
      recover_session(partial, folder / "out.h5", test::drilling_and_common());
  ASSERT_GE(recovery.samples, synced.rows);
  ASSERT_GE(recovery.passes, synced.passes);
  tally.by_recover += recovery.samples;
  tally.passes_by_recover += recovery.passes;
  if (recovery.anything()) {
    check_rows(SessionReader(folder / "out.h5"), recording, synced);
  }

  Resumed found;
  try {
    SessionWriter writer = SessionWriter::resume(file, found, test::drilling_and_common());
    ++(found.repaired.empty() ? tally.as_it_was : tally.repaired);
    tally.by_resume += found.rows;
    tally.passes_by_resume += found.passes.size();
    if (!recording.drills) {
      EXPECT_GE(found.rows, recovery.samples) << "resume did worse than recover";
    }
    check_rows(SessionReader(partial), recording, synced);
    go_on(writer, found, recording.drills);
    const SessionReader reader(file);
    ASSERT_EQ(reader.sample_count(), found.rows + 500);
    for (const std::string& problem : check_session(reader, test::drilling_and_common()).problems) {
      // Ticks that never came to the disk are missing, and nothing else is wrong.
      EXPECT_TRUE(problem.find("follows") != std::string::npos ||
                  problem.find("first sequence number") != std::string::npos ||
                  problem.find("ticks, but") != std::string::npos)
          << problem;
    }
    if (!found.repaired.empty()) {
      EXPECT_EQ(file_text(partial.string() + ".damaged"), bytes);
    }
  } catch (const InputError& error) {
    ++tally.refused;
    EXPECT_EQ(file_text(partial), bytes) << error.what();
    EXPECT_EQ(synced.rows, 0u) << error.what();
  }
}

void cut_after_every_write(bool drills) {
  const Recording recording(drills);
  Tally tally;
  const std::size_t stride = all_of_them() ? 1 : 23;
  for (std::size_t end = 3; end <= recording.steps.size(); end += stride) {
    try_file(recording, in_order(recording, end), synced_before(recording, end), tally);
    ASSERT_FALSE(testing::Test::HasFatalFailure()) << "after step " << end;
  }
  tally.print(drills ? "drilling, cut after a write" : "cut after a write");
  EXPECT_EQ(tally.refused, 0);
}

void reorder_what_was_not_synced(bool drills) {
  const Recording recording(drills);
  RandomStream random(12, "power cuts");
  Tally tally;
  const int files = all_of_them() ? 1000 : 40;
  for (int i = 0; i < files; ++i) {
    const std::size_t end = 3 + random.below(recording.steps.size() - 2);
    try_file(recording, reordered(recording, end, random), synced_before(recording, end), tally);
    ASSERT_FALSE(testing::Test::HasFatalFailure()) << "file " << i << ", at step " << end;
  }
  tally.print(drills ? "drilling, reordered" : "reordered");
  EXPECT_EQ(tally.refused, 0);
  EXPECT_GT(tally.repaired, files / 20) << "what was lost did no harm: the test is too kind";
}

TEST(PowerCutTest, AfterAnyWriteResumeAndRecoverKeepWhatWasSynced) { cut_after_every_write(false); }
TEST(PowerCutTest, AfterAnyWriteOfADrillingResumeAndRecoverKeepWhatWasSynced) {
  cut_after_every_write(true);
}
TEST(PowerCutTest, WhatWasNotSyncedMayBeLostOrReordered) { reorder_what_was_not_synced(false); }
TEST(PowerCutTest, WhatWasNotSyncedOfADrillingMayBeLostOrReordered) {
  reorder_what_was_not_synced(true);
}

}  // namespace
}  // namespace haptrial::record::power_cut_test
