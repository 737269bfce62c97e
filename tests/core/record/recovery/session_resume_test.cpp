#include "core/record/recovery/session_resume.h"
#include "core/base/file_text.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/base/error.h"
#include "core/bone/record/bone_rows.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recover.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/device_rows.h"
#include "core/record/table/schema.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::session_resume_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

template <typename Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

SessionInfo live_info() {
  SessionInfo info = test::example_info();
  info.clock = "real";
  return info;
}

/// Ticks of which each pass takes 2000 and a pause of 500 follows.
std::vector<Sample> ticks(std::uint64_t from, std::uint64_t to) {
  std::vector<Sample> samples = test::hand_motion(to, 4);
  for (Sample& sample : samples) {
    const std::uint64_t at = sample.sequence % 2500;
    sample.pass = at < 2000 ? static_cast<std::int32_t>(sample.sequence / 2500) : -1;
  }
  samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(from));
  return samples;
}

PassRow pass_row(std::uint64_t pass, PassStatus status = PassStatus::kCompleted) {
  return {static_cast<std::int32_t>(pass + 1),
          "haptic",
          Phase::kTest,
          1,
          1,
          7,
          2500 * pass,
          2500 * pass + 1999,
          status};
}

/// Leaves the file of a kill at this instant: a copy of the file while it is written.
void leave_as_killed(const TemporaryFolder& folder, const std::string& from,
                     const std::string& to) {
  fs::copy_file(folder / (from + ".partial"), folder / (to + ".partial"));
}

TEST(SessionResumeTest, GoesOnWhereTheSessionWasCut) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "first.h5", live_info());
    writer.append(ticks(0, 6000));
    writer.add_pass(pass_row(0));
    writer.add_pass(pass_row(1));
    writer.add_event({1, "session_start", "text"});
    writer.add_stimulus(
        std::vector<StimulusRow>{{1, 0.0, {0, 0, 0}, 1.0}, {1, 0.1, {0, 0, 0}, 2.0}});
    writer.add_frames(std::vector<FrameRow>{{1, 2, 0}});
    writer.sync();
    leave_as_killed(folder, "first.h5", "a.h5");
  }
  Resumed found;
  {
    SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
    EXPECT_EQ(found.info.participant.notes, "trägt Brille");
    EXPECT_EQ(found.rows, 6000u);
    EXPECT_EQ(found.next_sequence, 6000u);
    EXPECT_EQ(found.last_time_ns, 5999000000);
    EXPECT_EQ(found.passes.size(), 2u);
    EXPECT_THAT(found.blocks, ElementsAre(1));
    ASSERT_EQ(found.open_passes.size(), 1u);
    EXPECT_EQ(found.open_passes[0].row, 2);
    EXPECT_EQ(found.open_passes[0].first_sample, 5000u);
    EXPECT_EQ(found.open_passes[0].last_sample, 5999u);
    EXPECT_FALSE(found.ended);
    PassRow open = pass_row(2, PassStatus::kAborted);
    open.last_sample = 5999;
    writer.add_pass(open);
    std::vector<Sample> rest = ticks(6000, 9500);
    for (Sample& sample : rest) {
      if (sample.sequence < 7500) {
        sample.pass = -1;
      }
    }
    writer.append(rest);
    PassRow again = pass_row(3);
    again.attempt = 2;
    writer.add_pass(again);
    writer.add_event({2, "resumed", ""});
    writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {3500, 1, 0});
    writer.close();
  }
  const SessionReader reader(folder / "a.h5");
  const Integrity integrity = check_session(reader);
  EXPECT_THAT(integrity.problems, ElementsAre());
  EXPECT_EQ(integrity.rows, 9500u);
  EXPECT_EQ(integrity.overruns, 1u);
  EXPECT_EQ(reader.events().size(), 2u);
  EXPECT_EQ(reader.stimuli().size(), 2u);
  EXPECT_EQ(reader.frames().size(), 1u);
  EXPECT_EQ(reader.passes()[3].attempt, 2);
  const std::vector<Sample> whole = ticks(0, 9500);
  const std::vector<Sample> back = reader.samples(0, 9500);
  for (std::size_t i = 0; i < back.size(); ++i) {
    Sample expected = test::on_file(whole[i]);
    expected.pass = back[i].pass;
    ASSERT_TRUE(test::same(back[i], expected)) << i;
  }
}

TEST(SessionResumeTest, AnyNumberOfTimesAtAnyLength) {
  const TemporaryFolder folder;
  { SessionWriter(folder / "a.h5", live_info()); }
  const std::vector<Sample> samples = ticks(0, 9000);
  // Around chunks of 768 rows, and nothing at all.
  for (const std::uint64_t end : {0u, 1u, 767u, 768u, 768u, 769u, 1536u, 3000u, 9000u}) {
    Resumed found;
    SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
    ASSERT_LE(found.next_sequence, end);
    EXPECT_EQ(found.rows, found.next_sequence);
    EXPECT_EQ(found.dropped_rows, 0u);
    writer.append(std::span(samples).subspan(found.rows, end - found.rows));
    writer.flush();
  }
  Resumed found;
  SessionWriter::resume(folder / "a.h5", found).close();
  const SessionReader reader(folder / "a.h5");
  ASSERT_EQ(reader.sample_count(), 9000u);
  const std::vector<Sample> back = reader.samples(0, 9000);
  for (std::size_t i = 0; i < back.size(); ++i) {
    ASSERT_TRUE(test::same(back[i], test::on_file(samples[i]))) << i;
  }
}

TEST(SessionResumeTest, APassWithoutAllOfItsSamplesIsOpenAgain) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", live_info());
    writer.append(ticks(0, 4300));
    writer.add_pass(pass_row(0));
    writer.add_pass(pass_row(1));  // its last 200 samples never came
  }
  Resumed found;
  {
    SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
    EXPECT_EQ(found.passes.size(), 1u);
    EXPECT_EQ(found.dropped_passes, 1u);
    ASSERT_EQ(found.open_passes.size(), 1u);
    EXPECT_EQ(found.open_passes[0].last_sample, 4299u);
    PassRow open = pass_row(1, PassStatus::kAborted);
    open.last_sample = 4299;
    writer.add_pass(open);
    writer.set_timing({}, {0, 0, 0});
    writer.close();
  }
  const SessionReader reader(folder / "a.h5");
  ASSERT_EQ(reader.passes().size(), 2u);
  EXPECT_EQ(reader.passes()[0].status, PassStatus::kCompleted);
  EXPECT_EQ(reader.passes()[1].status, PassStatus::kAborted);
  EXPECT_TRUE(check_session(reader).ok);
}

/// Answers are in the file at once, samples when their chunk is full: a kill may keep the one and
/// lose the others. The next pass gets the row of the lost one, but not its answers.
TEST(SessionResumeTest, AnswersOfAPassThatLeftNoSamplesAreDropped) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", live_info(), {&responses_table()});
    writer.append(ticks(0, 4300));
    writer.add_pass(pass_row(0));
    for (const std::int32_t pass : {0, 1, 2}) {  // of 1 there are samples, and no row; of 2 none
      ResponseRow answer;
      answer.pass = pass;
      answer.question = "which";
      writer.add_response(answer);
    }
  }
  Resumed found;
  SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
  EXPECT_THAT(found.repaired, HasSubstr("pass 2 of /responses is not in /samples"));
  ASSERT_EQ(found.open_passes.size(), 1u);
  EXPECT_EQ(found.open_passes[0].row, 1);
  for (const ResponseRow& row : found.responses) {
    EXPECT_LT(row.pass, 2);
  }
  EXPECT_GE(found.responses.size(), 1u);
  EXPECT_TRUE(fs::exists(folder / "a.h5.partial.damaged"));
}

/// Ticks as before, without a pass.
std::vector<Sample> ticks_between_passes(std::uint64_t from, std::uint64_t to) {
  std::vector<Sample> samples = ticks(from, to);
  for (Sample& sample : samples) {
    sample.pass = -1;
  }
  return samples;
}

/// A chunk of /devices may be full before that of /samples: a kill loses ticks of which it has the
/// second device. Their numbers are those of the next run's ticks.
TEST(SessionResumeTest, RowsOfTicksThatAKillLostAreDropped) {
  for (const std::uint64_t kept : {std::uint64_t{0}, std::uint64_t{2000}}) {
    const TemporaryFolder folder;
    const TableList tables{&table_of<DeviceRow>()};
    {
      SessionWriter writer(folder / "a.h5", live_info(), tables);
      std::vector<DeviceRow> second(kept + 300);
      for (std::size_t i = 0; i < second.size(); ++i) {
        second[i].sequence = i;
      }
      writer.add(std::span<const DeviceRow>(second));
      writer.append(ticks_between_passes(0, kept));
    }
    Resumed found;
    {
      SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
      EXPECT_THAT(found.repaired, HasSubstr("/devices refers to ticks that are missing"));
      EXPECT_EQ(found.next_sequence, kept);
      std::vector<DeviceRow> second(500);
      for (std::size_t i = 0; i < second.size(); ++i) {
        second[i].sequence = kept + i;
        second[i].buttons = 1;
      }
      writer.add(std::span<const DeviceRow>(second));
      writer.append(ticks_between_passes(kept, kept + 500));
      writer.set_timing({}, {500, 0, 0});
      writer.close();
    }
    const SessionReader reader(folder / "a.h5");
    const std::vector<DeviceRow> rows = reader.rows<DeviceRow>();
    ASSERT_EQ(rows.size(), kept + 500);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].sequence, i);
      ASSERT_EQ(rows[i].buttons, i < kept ? 0 : 1) << i;
    }
    EXPECT_THAT(check_session(reader).problems, ElementsAre());
  }
}

// The first pass of a drilling without blood and heat leaves such a row in /field.
TEST(SessionResumeTest, AFirstRowOfZerosIsARow) {
  const TemporaryFolder folder;
  const TableList tables = with_tables({&table_of<FieldRow>()}, common_tables());
  {
    SessionWriter writer(folder / "a.h5", live_info(), tables);
    writer.append(ticks(0, 4300));
    writer.add_pass(pass_row(0));
    writer.add(std::span<const FieldRow>(std::vector<FieldRow>(1)));
  }
  const std::string damaged = "cut\n" + file_text(folder / "a.h5.partial").substr(512);
  Resumed found;
  SessionWriter::resume(folder / "a.h5", found, tables).close();
  EXPECT_EQ(found.repaired, "");
  EXPECT_EQ(found.rows, 4300u);
  EXPECT_THAT(found.passes, testing::SizeIs(1));
  EXPECT_THAT(SessionReader(folder / "a.h5").rows<FieldRow>(), testing::SizeIs(1));

  std::ofstream(folder / "damaged.h5", std::ios::binary) << damaged;
  ASSERT_TRUE(recover_session(folder / "damaged.h5", folder / "out.h5", tables).anything());
  EXPECT_THAT(SessionReader(folder / "out.h5").rows<FieldRow>(), testing::SizeIs(1));
}

TEST(SessionResumeTest, ASessionWhoseLoopHadEndedNeedsOnlyToBeClosed) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", live_info());
    writer.append(ticks(0, 300));
    writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {300, 0, 0});
  }
  Resumed found;
  SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
  EXPECT_TRUE(found.ended);
  EXPECT_THROW(writer.set_timing({}, {}), std::invalid_argument);
  EXPECT_EQ(found.runs.back().state, RunState::kEnded);
  writer.close();
  EXPECT_EQ(SessionReader(folder / "a.h5").timing().size(), 1u);
  EXPECT_EQ(SessionReader(folder / "a.h5").timing_summary()->ticks, 300u);
}

TEST(SessionResumeTest, SaysWhenThereIsNothingToGoOnWith) {
  const TemporaryFolder folder;
  Resumed found;
  EXPECT_FALSE(SessionWriter::can_resume(folder / "a.h5"));
  EXPECT_THAT(refusal([&] { SessionWriter::resume(folder / "a.h5", found); }),
              HasSubstr("a.h5.partial: no such file"));
  // Killed while it was created: under this name no file can take a sample.
  std::ofstream(folder / "a.h5.partial.new") << "half a header";
  EXPECT_FALSE(SessionWriter::can_resume(folder / "a.h5"));
  SessionWriter writer(folder / "a.h5", live_info());
  EXPECT_FALSE(fs::exists(folder / "a.h5.partial.new"));
  EXPECT_TRUE(SessionWriter::can_resume(folder / "a.h5"));
  writer.close();
  EXPECT_THAT(refusal([&] { SessionWriter::can_resume(folder / "a.h5"); }),
              HasSubstr("the session is complete"));
}

TEST(SessionResumeTest, RefusesAFileThatDoesNotSayWhatItWasAndLeavesIt) {
  const TemporaryFolder folder;
  for (const std::string& what : {std::string(), std::string(9000, '\0'), std::string("no file")}) {
    std::ofstream(folder / "a.h5.partial", std::ios::binary) << what;
    Resumed found;
    EXPECT_THAT(refusal([&] { SessionWriter::resume(folder / "a.h5", found); }),
                testing::AllOf(HasSubstr("a.h5.partial"), HasSubstr("haptrial recover")));
    EXPECT_EQ(file_text(folder / "a.h5.partial"), what);
    EXPECT_FALSE(fs::exists(folder / "a.h5.partial.damaged"));
  }
}

/// A damaged file of 20000 ticks in 26 chunks, and what a resume keeps of it.
struct Damaged {
  TemporaryFolder folder;
  std::string bytes;
  Resumed found;

  Damaged() {
    SessionWriter writer(folder / "whole.h5", live_info());
    writer.append(ticks(0, 20000));
    for (std::uint64_t pass = 0; pass < 7; ++pass) {
      PassRow begun = pass_row(pass);
      begun.phase = Phase::kTraining;
      writer.begin_pass({static_cast<std::int32_t>(pass), begun});
      writer.add_pass(pass_row(pass));
    }
    writer.sync();
    bytes = file_text(folder / "whole.h5.partial");
  }
  void resume(const std::string& damaged) {
    std::ofstream(folder / "a.h5.partial", std::ios::binary) << damaged;
    SessionWriter::resume(folder / "a.h5", found);
    EXPECT_THAT(found.repaired, HasSubstr("a.h5.partial.damaged"));
    EXPECT_EQ(file_text(folder / "a.h5.partial.damaged"), damaged);
    EXPECT_FALSE(fs::exists(folder / "a.h5.partial.repaired"));
    EXPECT_EQ(found.events.back().kind, "repaired");
    EXPECT_EQ(found.events.back().text, found.repaired);
    // It is whole from now on.
    Resumed again;
    SessionWriter::resume(folder / "a.h5", again);
    EXPECT_EQ(again.repaired, "");
    EXPECT_EQ(again.rows, found.rows);
  }
};

/// HDF5's own lock, as a program that reads the file has it.
class ReaderLock {
 public:
  explicit ReaderLock(const fs::path& file) : descriptor_(::open(file.c_str(), O_RDONLY)) {
    EXPECT_EQ(::flock(descriptor_, LOCK_SH | LOCK_NB), 0);
  }
  ~ReaderLock() { ::close(descriptor_); }
  ReaderLock(const ReaderLock&) = delete;
  ReaderLock& operator=(const ReaderLock&) = delete;

 private:
  int descriptor_;
};

TEST(SessionResumeTest, SaysThatAnotherProgramHasTheFileOpen) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "first.h5", live_info());
    writer.append(ticks(0, 3000));
    writer.sync();
    leave_as_killed(folder, "first.h5", "a.h5");
  }
  Resumed found;
  {
    const ReaderLock reader(folder / "a.h5.partial");
    EXPECT_THAT(refusal([&] { SessionWriter::resume(folder / "a.h5", found); }),
                HasSubstr("a.h5.partial: another program has the file open, such as a viewer or a "
                          "script that reads it; close the file there, then resume again"));
  }
  EXPECT_NO_THROW(SessionWriter::resume(folder / "a.h5", found).discard());
}

TEST(SessionResumeTest, AFileWithoutItsHeaderIsRepairedWhole) {
  Damaged file;
  file.resume(std::string(512, '\0') + file.bytes.substr(512));
  EXPECT_EQ(file.found.rows, 20000u);
  EXPECT_EQ(file.found.passes.size(), 7u);
}

TEST(SessionResumeTest, OfAFileCutShortWhatIsLeftIsKept) {
  Damaged file;
  file.resume(file.bytes.substr(0, file.bytes.size() / 2));
  EXPECT_GT(file.found.rows, 8000u);
  EXPECT_GE(file.found.passes.size(), 3u);
  EXPECT_LT(file.found.passes.size(), 7u);
  for (const PassRow& pass : file.found.passes) {
    EXPECT_EQ(pass.status, PassStatus::kCompleted);
    EXPECT_LT(pass.last_sample, file.found.rows);
  }
}

TEST(SessionResumeTest, APassThatLostSamplesIsDamagedAndTheRestIsKept) {
  Damaged file;
  std::string bytes = file.bytes;
  bytes.replace(bytes.size() / 2, 4096, 4096, '\0');
  file.resume(bytes);
  EXPECT_LT(file.found.rows, 20000u);
  EXPECT_GE(file.found.rows, 20000u - 2 * 768u);
  ASSERT_EQ(file.found.passes.size(), 7u);
  const auto damaged =
      std::count_if(file.found.passes.begin(), file.found.passes.end(),
                    [](const PassRow& pass) { return pass.status == PassStatus::kDamaged; });
  EXPECT_GE(damaged, 1);
  EXPECT_LE(damaged, 2);
  EXPECT_EQ(static_cast<std::uint64_t>(damaged), file.found.dropped_passes);
}

TEST(SessionResumeTest, AFileOfVersionOneGoesOnInTheNewLayout) {
  const TemporaryFolder folder;
  fs::copy_file(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version1.hdf5",
                folder / "old.h5.partial");
  Resumed found;
  SessionWriter::resume(folder / "old.h5", found);
  EXPECT_THAT(found.repaired, HasSubstr("schema version 1"));
  EXPECT_EQ(found.rows, 500u);
  EXPECT_EQ(found.passes.size(), 2u);
  EXPECT_EQ(found.info.subject, "P07");
}

/// A chunk that an older copy stands for is not believed.
TEST(SessionResumeTest, CopiesOfAFileWhileItIsWrittenAreNeverMisread) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "first.h5", live_info());
  std::string older;
  for (std::uint64_t at = 0; at < 8000; at += 500) {
    writer.append(ticks(at, at + 500));
    writer.sync();
    const std::string now = file_text(folder / "first.h5.partial");
    // The first page, where HDF5 keeps its structure, of a moment before.
    if (!older.empty()) {
      std::ofstream(folder / "a.h5.partial", std::ios::binary)
          << older.substr(0, 4096) << now.substr(4096);
      Resumed found;
      SessionWriter::resume(folder / "a.h5", found);
      ASSERT_EQ(found.rows, at + 500);
      ASSERT_EQ(found.next_sequence, at + 500);
      fs::remove(folder / "a.h5.partial.damaged");
    }
    older = now;
  }
}

TEST(SessionResumeTest, ADiscardAfterAResumeKeepsWhatWasThere) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", live_info());
    writer.append(ticks(0, 3000));
  }
  Resumed found;
  SessionWriter::resume(folder / "a.h5", found).discard();
  EXPECT_EQ(SessionReader(folder / "a.h5.partial").sample_count(), 3000u);
}

TEST(SessionResumeTest, WhatEarlierRunsCountedIsAdded) {
  const TemporaryFolder folder;
  {
    SessionWriter writer(folder / "a.h5", live_info());
    writer.set_planned(36);
    writer.append(ticks(0, 1000));
    writer.note_counts({500, 2, 0});
    writer.note_counts({900, 5, 1});
    writer.flush();  // and is killed
    leave_as_killed(folder, "a.h5", "b.h5");
  }
  Resumed found;
  std::uint64_t ticks_before = 0;
  {
    SessionWriter writer = SessionWriter::resume(folder / "b.h5", found);
    ticks_before = found.next_sequence;
    EXPECT_EQ(found.earlier.overruns, 5u);
    EXPECT_EQ(found.earlier.dropped, 1u);
    writer.append(ticks(ticks_before, ticks_before + 100));
    writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {100, 7, 0}, RunState::kStopped);
    writer.sync();
    EXPECT_FALSE(SessionReader(folder / "b.h5.partial").timing_summary());
  }
  SessionWriter writer = SessionWriter::resume(folder / "b.h5", found);
  EXPECT_FALSE(found.ended);
  writer.append(ticks(found.next_sequence, found.next_sequence + 10));
  writer.set_timing(std::vector<TimingRow>{{0, 1, 10, 10, 10}}, {10, 1, 0});
  writer.close();
  const SessionReader reader(folder / "b.h5");
  EXPECT_EQ(reader.timing_summary()->ticks, ticks_before + 110);
  EXPECT_EQ(reader.timing_summary()->overruns, 13u);
  EXPECT_EQ(reader.timing_summary()->dropped, 1u);
  ASSERT_EQ(reader.runs().size(), 4u);
  EXPECT_EQ(reader.runs()[0].counts.overruns, 2u);
  EXPECT_EQ(reader.runs()[0].planned, 36);
  EXPECT_EQ(reader.runs()[2].run, 2);
  EXPECT_EQ(reader.runs()[2].first_sample, ticks_before);
  EXPECT_EQ(reader.runs()[2].state, RunState::kStopped);
  EXPECT_EQ(reader.runs()[3].state, RunState::kEnded);
  ASSERT_EQ(reader.timing().size(), 1u);  // of both runs
  EXPECT_EQ(reader.timing()[0].period_count, 12u);
}

TEST(SessionVersionTest, AFileOfVersionOneIsRead) {
  const SessionReader reader(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version1.hdf5");
  EXPECT_EQ(reader.version(), 1);
  EXPECT_EQ(reader.info().subject, "P07");
  EXPECT_EQ(reader.info().participant.identifier, "");
  EXPECT_EQ(reader.sample_count(), 500u);
  ASSERT_EQ(reader.passes().size(), 2u);
  EXPECT_FALSE(reader.passes()[1].practice);
  EXPECT_EQ(reader.passes()[1].attempt, 1);
  EXPECT_EQ(reader.passes()[1].status, PassStatus::kAborted);
  EXPECT_EQ(reader.passes()[1].last_sample, 449u);
  EXPECT_TRUE(reader.frames().empty());
  EXPECT_TRUE(check_session(reader).ok);
}

}  // namespace
}  // namespace haptrial::record::session_resume_test
