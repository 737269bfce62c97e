// Sessions on the real clock: what is in the file while they run, and what it costs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>

#include "core/base/error.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"
#include "tests/core/record/session_fixture.h"
#include "tests/support/message_of.h"
#include "tests/support/wait.h"

namespace haptrial::record::session_live_test {
namespace {

namespace fs = std::filesystem;
using test::hand_motion;
using test::message_of;
using test::on_file;
using test::same;
using test::TemporaryFolder;
using testing::HasSubstr;

SessionInfo live_info() {
  SessionInfo info = test::example_info();
  info.clock = "real";
  return info;
}

/// Writes an hour in batches of 20 ms. @param flush_rows, sync_rows  0: never
fs::path write_hour(const fs::path& file, const std::vector<Sample>& samples, bool live,
                    std::size_t flush_rows, std::size_t sync_rows) {
  SessionWriter writer(file, live ? live_info() : test::example_info());
  for (std::size_t at = 0; at < samples.size(); at += 20) {
    writer.append(std::span(samples).subspan(at, 20));
    const std::size_t done = at + 20;
    if (flush_rows > 0 && done % flush_rows == 0) {
      writer.flush();
    }
    if (sync_rows > 0 && done % sync_rows == 0) {
      writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, done - sync_rows, done - 1, {}});
      writer.sync();
    }
  }
  writer.close();
  return file;
}

TEST(SessionLiveTest, AFlushEverySecondForAnHourMakesTheFileLittleLarger) {
  constexpr std::size_t kRows = 3600000;
  constexpr std::size_t kPart = 600000;  // ten minutes, six times over
  const TemporaryFolder folder;
  std::vector<Sample> samples = hand_motion(kPart, 1);
  samples.reserve(kRows);
  for (std::size_t i = kPart; i < kRows; ++i) {
    Sample sample = samples[i - kPart];
    sample.sequence = i;
    sample.time_ns = static_cast<std::int64_t>(i) * 1000000;
    samples.push_back(sample);
  }
  const auto plain = fs::file_size(write_hour(folder / "a.h5", samples, false, 0, 0));
  const auto live = fs::file_size(write_hour(folder / "b.h5", samples, true, 1000, 18000));
  const double penalty = static_cast<double>(live) / static_cast<double>(plain) - 1.0;
  std::printf("an hour: %.1f MB plain, %.1f MB live (%.1f %% more)\n",
              1e-6 * static_cast<double>(plain), 1e-6 * static_cast<double>(live), 100.0 * penalty);
  EXPECT_LT(penalty, 0.4);  // short chunks, and each begins on a page
  EXPECT_EQ(SessionReader(folder / "b.h5").sample_count(), kRows);
}

TEST(SessionLiveTest, ChunksLastAtMostEightTenthsOfASecond) {
  for (const double rate : {100.0, 500.0, 1000.0, 1234.5, 2000.0, 4000.0, 5000.0}) {
    const auto rows = static_cast<double>(live_chunk_rows(rate));
    EXPECT_LE(rows, 0.8 * rate) << rate;
    EXPECT_GE(rows, 0.64 * rate - 64.0) << rate;
  }
  EXPECT_EQ(live_chunk_rows(1.0), kLiveChunkStep);
  EXPECT_EQ(live_chunk_rows(1e6), samples_table().schema().chunk_rows);
}

TEST(SessionLiveTest, WithoutAnyFlushALiveFileLacksLessThanASecond) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(20000, 2);
  SessionWriter writer(folder / "a.h5", live_info());
  for (std::size_t at = 0; at < samples.size(); at += 20) {
    writer.append(std::span(samples).subspan(at, 20));
    if (at % 1900 != 0) {
      continue;
    }
    // The file is opened as another process would, from a copy: HDF5 shares files within one.
    fs::copy_file(folder / "a.h5.partial", folder / "copy.h5",
                  fs::copy_options::overwrite_existing);
    const std::uint64_t rows = SessionReader(folder / "copy.h5").sample_count();
    EXPECT_GE(rows + 800, at + 20);
    EXPECT_LE(rows, at + 20);
  }
}

TEST(SessionLiveTest, SyncBringsEverything) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(1001, 2);
  SessionWriter writer(folder / "a.h5", live_info());
  writer.append(samples);
  writer.add_frames(std::vector<FrameRow>{{1, 2, 3}});
  writer.add_event({5, "note", "text"});
  writer.sync();
  fs::copy_file(folder / "a.h5.partial", folder / "copy.h5");
  const SessionReader reader(folder / "copy.h5");
  EXPECT_EQ(reader.sample_count(), 1001u);
  ASSERT_EQ(reader.frames().size(), 1u);
  EXPECT_EQ(reader.frames()[0].frame_time_ns, 2);
  EXPECT_EQ(reader.events().size(), 1u);
}

/// A row of /trials is never in a file without its samples.
TEST(SessionLiveTest, FlushKeepsSamplesAheadOfTheirPass) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(70 * 130, 2);
  SessionWriter writer(folder / "a.h5", live_info());
  for (std::uint64_t pass = 0; pass < 70; ++pass) {
    writer.append(std::span(samples).subspan(pass * 130, 130));
    writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, pass * 130, pass * 130 + 129, {}});
    if (pass % 3 == 0) {
      writer.flush();
    }
    fs::copy_file(folder / "a.h5.partial", folder / "copy.h5",
                  fs::copy_options::overwrite_existing);
    const SessionReader reader(folder / "copy.h5");
    for (const PassRow& row : reader.passes()) {
      EXPECT_LT(row.last_sample, reader.sample_count());
    }
    if (pass % 3 == 0) {
      EXPECT_EQ(reader.passes().size(), pass + 1);
    }
  }
}

TEST(SessionLiveTest, AnotherProcessFollowsWithH5pyAndTheReader) {
  const TemporaryFolder folder;
  const fs::path partial = folder / "a.h5.partial";
  const std::vector<Sample> samples = hand_motion(40000, 3);
  int go[2], told[2];
  ASSERT_EQ(pipe(go), 0);
  ASSERT_EQ(pipe(told), 0);
  const pid_t pid = fork();
  if (pid == 0) {
    SessionWriter writer(folder / "a.h5", live_info());
    for (std::size_t at = 0; at < samples.size(); at += 10000) {
      writer.append(std::span(samples).subspan(at, 10000));
      writer.flush();
      char byte = 'f';
      if (write(told[1], &byte, 1) != 1 || read(go[0], &byte, 1) != 1) {
        _exit(1);
      }
    }
    writer.close();
    _exit(0);
  }
  // One h5py process keeps the file open and refreshes; each line of its output is a row count.
  const std::string script = fmt::format(
      "import h5py,sys\n"
      "f=h5py.File('{}','r',swmr=True); d=f['samples']\n"
      "for line in sys.stdin:\n"
      "  d.refresh(); n=len(d); a=d['sequence'][:]\n"
      "  assert (a==range(n)).all(); print(n,file=open('{}','w'),flush=True)\n"
      "  open('{}','w').close()\n",
      partial.string(), (folder / "count").string(), (folder / "done").string());
  std::ofstream(folder / "follow.py") << script;
  char byte = 0;
  ASSERT_EQ(read(told[0], &byte, 1), 1);
  FILE* python = popen(("/usr/bin/python3 " + (folder / "follow.py").string()).c_str(), "w");
  ASSERT_NE(python, nullptr);
  for (std::size_t at = 10000; at <= samples.size(); at += 10000) {
    if (at > 10000) {
      ASSERT_EQ(read(told[0], &byte, 1), 1);
    }
    std::fputs("look\n", python);
    std::fflush(python);
    test::wait_until([&] { return fs::exists(folder / "done"); });
    fs::remove(folder / "done");
    std::size_t seen = 0;
    std::ifstream(folder / "count") >> seen;
    EXPECT_GE(seen + 800, at);
    EXPECT_LE(seen, at);
    EXPECT_EQ(SessionReader(partial).sample_count(), seen);
    ASSERT_EQ(write(go[1], &byte, 1), 1);
  }
  EXPECT_EQ(pclose(python), 0);
  int status = 1;
  waitpid(pid, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(SessionLiveTest, AFileInUseIsRefusedUntilItsProcessDies) {
  const TemporaryFolder folder;
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t pid = fork();
  if (pid == 0) {
    SessionWriter writer(folder / "a.h5", live_info());
    writer.append(hand_motion(5000, 1));
    char byte = 'r';
    if (write(told[1], &byte, 1) != 1) {
      _exit(1);
    }
    for (;;) {
      pause();
    }
  }
  char byte = 0;
  ASSERT_EQ(read(told[0], &byte, 1), 1);
  Resumed found;
  EXPECT_THAT(message_of<InputError>([&] { SessionWriter(folder / "a.h5", live_info()); }),
              HasSubstr("another haptrial records into it"));
  EXPECT_THAT(message_of<InputError>([&] { SessionWriter::resume(folder / "a.h5", found); }),
              HasSubstr("is in use by another haptrial"));
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  EXPECT_THAT(message_of<InputError>([&] { SessionWriter(folder / "a.h5", live_info()); }),
              HasSubstr("from an unfinished session"));
  SessionWriter writer = SessionWriter::resume(folder / "a.h5", found);
  EXPECT_TRUE(writer.can_go_on());
  EXPECT_THAT(message_of<InputError>([&] { SessionWriter::resume(folder / "a.h5", found); }),
              HasSubstr("is in use by another haptrial"));
}

}  // namespace
}  // namespace haptrial::record::session_live_test
