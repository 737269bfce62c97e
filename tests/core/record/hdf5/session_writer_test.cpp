#include "core/record/hdf5/session_writer.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "tests/core/record/session_fixture.h"
#include "tests/support/message_of.h"

namespace haptrial::record::session_writer_test {
namespace {

namespace fs = std::filesystem;
using test::example_info;
using test::hand_motion;
using test::message_of;
using test::on_file;
using test::same;
using test::TemporaryFolder;
using testing::HasSubstr;

void expect_prefix(const fs::path& file, const std::vector<Sample>& samples) {
  const SessionReader reader(file);
  ASSERT_LE(reader.sample_count(), samples.size());
  const std::vector<Sample> back = reader.samples(0, reader.sample_count());
  for (std::size_t i = 0; i < back.size(); ++i) {
    ASSERT_TRUE(same(back[i], on_file(samples[i]))) << "row " << i;
  }
}

TEST(SessionWriterTest, RefusesWhatItWouldOverwriteOrCannotReach) {
  const TemporaryFolder folder;
  const auto refusal = [](const fs::path& file) {
    return message_of<InputError>([&] { SessionWriter(file, example_info()); });
  };
  std::ofstream(folder / "there.h5") << "x";
  std::ofstream(folder / "half.h5.partial") << "x";
  EXPECT_THAT(refusal(folder / "there.h5"), HasSubstr("there.h5: exists already"));
  EXPECT_THAT(refusal(folder / "half.h5"), HasSubstr("half.h5.partial: exists already"));
  EXPECT_THAT(refusal(folder / "none" / "a.h5"), HasSubstr("none does not exist"));
  EXPECT_THAT(refusal(folder / "there.h5" / "a.h5"), HasSubstr("there.h5 does not exist"));
  EXPECT_THAT(refusal(folder / ""), HasSubstr("no file name"));
  if (geteuid() == 0) {
    GTEST_LOG_(INFO) << "root may write anywhere: the read-only folder is not tried";
  } else {
    fs::create_directory(folder / "locked");
    fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THAT(refusal(folder / "locked" / "a.h5"), HasSubstr("may not be written"));
  }
  SessionInfo info = example_info();
  info.definition = std::string("a\0b", 3);
  EXPECT_THAT(message_of<InputError>([&] { SessionWriter(folder / "nul.h5", info); }),
              HasSubstr("definition holds a NUL byte"));
  // Nothing came into being, and nothing was changed.
  EXPECT_FALSE(fs::exists(folder / "nul.h5.partial"));
  EXPECT_FALSE(fs::exists(folder / "there.h5.partial"));
  EXPECT_EQ(fs::file_size(folder / "half.h5.partial"), 1u);
}

TEST(SessionWriterTest, HasItsNameOnlyOnceClosed) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", example_info());
  EXPECT_TRUE(fs::exists(folder / "a.h5.partial"));
  EXPECT_FALSE(fs::exists(folder / "a.h5"));
  writer.close();
  EXPECT_FALSE(fs::exists(folder / "a.h5.partial"));
  EXPECT_TRUE(fs::exists(folder / "a.h5"));
  EXPECT_THROW(writer.close(), std::invalid_argument);
  EXPECT_THROW(writer.flush(), std::invalid_argument);
  EXPECT_THROW(writer.append({}), std::invalid_argument);
  EXPECT_THROW(writer.discard(), std::invalid_argument);
  EXPECT_TRUE(fs::exists(folder / "a.h5"));
}

TEST(SessionWriterTest, CloseDoesNotOverwriteAFileThatCameMeanwhile) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(100, 1);
  SessionWriter writer(folder / "a.h5", example_info());
  writer.append(samples);
  std::ofstream(folder / "a.h5") << "other";
  EXPECT_THAT(message_of<RunError>([&] { writer.close(); }), HasSubstr("File exists"));
  EXPECT_EQ(fs::file_size(folder / "a.h5"), 5u);
  EXPECT_EQ(SessionReader(folder / "a.h5.partial").sample_count(), 100u);
}

TEST(SessionWriterTest, WithoutCloseThePartialHoldsEverything) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(5000, 1);
  {
    SessionWriter writer(folder / "a.h5", example_info());
    writer.append(samples);
    writer.add_event({1, "break", ""});
  }
  EXPECT_FALSE(fs::exists(folder / "a.h5"));
  const SessionReader reader(folder / "a.h5.partial");
  EXPECT_EQ(reader.sample_count(), samples.size());
  EXPECT_EQ(reader.events().size(), 1u);
  EXPECT_FALSE(reader.timing_summary().has_value());
  expect_prefix(folder / "a.h5.partial", samples);
}

TEST(SessionWriterTest, DiscardLeavesNothing) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", example_info());
  writer.append(hand_motion(5000, 1));
  writer.discard();
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_THROW(writer.flush(), std::invalid_argument);
}

TEST(SessionWriterTest, TimingIsSetOnce) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", example_info());
  writer.set_timing({}, {1, 2, 3});
  EXPECT_THROW(writer.set_timing({}, {4, 5, 6}), std::invalid_argument);
  writer.close();
  EXPECT_EQ(SessionReader(folder / "a.h5").timing_summary()->ticks, 1u);
}

/// Writes 700 samples and a pass at a time and reports each flush, until killed.
[[noreturn]] void write_for_ever(const fs::path& file, const std::vector<Sample>& samples,
                                 int report) {
  SessionWriter writer(file, example_info());
  for (std::uint64_t at = 0; at + 700 <= samples.size(); at += 700) {
    writer.append(std::span(samples).subspan(at, 700));
    writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 0, at, at + 699, {}});
    writer.flush();
    const std::uint64_t flushed = at + 700;
    if (write(report, &flushed, sizeof flushed) != sizeof flushed) {
      _exit(1);
    }
  }
  for (;;) {
    pause();
  }
}

TEST(SessionWriterTest, KilledAtAnyInstantItKeepsWhatWasFlushed) {
  const std::vector<Sample> samples = hand_motion(200000, 1);
  for (int run = 0; run < 25; ++run) {
    const TemporaryFolder folder;
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t pid = fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) {
      write_for_ever(folder / "a.h5", samples, ends[1]);
    }
    close(ends[1]);
    // Let some flushes pass, then strike anywhere within the next ones.
    std::uint64_t flushed = 0;
    for (int i = 0; i <= run % 7; ++i) {
      ASSERT_EQ(read(ends[0], &flushed, sizeof flushed), ssize_t{sizeof flushed});
    }
    usleep(static_cast<useconds_t>(137 * run));
    kill(pid, SIGKILL);
    int status = 0;
    waitpid(pid, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    while (read(ends[0], &flushed, sizeof flushed) == sizeof flushed) {
    }
    close(ends[0]);
    expect_prefix(folder / "a.h5.partial", samples);
    const SessionReader reader(folder / "a.h5.partial");
    EXPECT_GE(reader.sample_count(), flushed);
    EXPECT_LE(reader.sample_count(), flushed + 700);
    EXPECT_GE(reader.passes().size(), flushed / 700);
    EXPECT_EQ(reader.info().subject, "P07");
  }
}

TEST(SessionWriterTest, AnotherProcessReadsWhileItIsWritten) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(9000, 1);
  int ready[2], done[2];
  ASSERT_EQ(pipe(ready), 0);
  ASSERT_EQ(pipe(done), 0);
  const pid_t pid = fork();
  if (pid == 0) {
    SessionWriter writer(folder / "a.h5", example_info());
    writer.append(std::span(samples).first(7000));
    writer.flush();
    char byte = 'r';
    bool good = write(ready[1], &byte, 1) == 1 && read(done[0], &byte, 1) == 1;
    writer.append(std::span(samples).subspan(7000));
    writer.close();
    _exit(good ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_EQ(SessionReader(folder / "a.h5.partial").sample_count(), 7000u);
  expect_prefix(folder / "a.h5.partial", samples);
  ASSERT_EQ(write(done[1], &byte, 1), 1);
  int status = 0;
  waitpid(pid, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(SessionReader(folder / "a.h5").sample_count(), 9000u);
}

/// Writes until it fails, checks that the failure stays, and that the file holds a prefix.
void expect_full_disk(const fs::path& file, const char* reason) {
  const std::vector<Sample> samples = hand_motion(400000, 1);
  {
    SessionWriter writer(file, example_info());
    const std::string message = message_of<RunError>([&] {
      for (std::size_t at = 0; at < samples.size(); at += 1000) {
        writer.append(std::span(samples).subspan(at, 1000));
      }
      writer.close();
    });
    EXPECT_FALSE(writer.can_go_on());
    EXPECT_THAT(message, HasSubstr(reason));
    EXPECT_THAT(message, HasSubstr(file.string() + ": the session cannot be written"));
    EXPECT_EQ(message_of<RunError>([&] { writer.append(samples); }), message);
    EXPECT_EQ(message_of<RunError>([&] { writer.flush(); }), message);
    EXPECT_EQ(message_of<RunError>([&] { writer.close(); }), message);
  }
  EXPECT_FALSE(fs::exists(file));
  expect_prefix(file.string() + ".partial", samples);
  EXPECT_GT(SessionReader(file.string() + ".partial").sample_count(), 0u);
}

TEST(SessionWriterTest, ALimitOfTheFileSizeIsASentence) {
  const TemporaryFolder folder;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit old_limit {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  struct rlimit limit = old_limit;
  limit.rlim_cur = 1500000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  expect_full_disk(folder / "a.h5", "File too large");
  limit.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THAT(message_of<RunError>([&] { SessionWriter(folder / "b.h5", example_info()); }),
              HasSubstr("cannot be created (File too large)"));
  EXPECT_FALSE(fs::exists(folder / "b.h5.partial"));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old_limit), 0);
  std::signal(SIGXFSZ, old_handler);
}

TEST(SessionWriterTest, AFullDiskIsASentence) {
  const TemporaryFolder folder;
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=1m") != 0) {
    GTEST_SKIP() << "mounting a small disk needs root: " << std::strerror(errno);
  }
  expect_full_disk(disk / "a.h5", "No space left on device");
  EXPECT_EQ(umount(disk.c_str()), 0);
}

/// The descriptor through which this process writes the file: the last one, behind the lock's.
int descriptor_of(const fs::path& file) {
  int last = -1;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code ignored;
    if (fs::read_symlink(entry.path(), ignored) == file) {
      last = std::max(last, std::stoi(entry.path().filename()));
    }
  }
  return last;
}

TEST(SessionWriterTest, AWriteThatFailsWithinHdf5IsASentenceAndTheFileStaysReadable) {
  const std::vector<Sample> samples = hand_motion(100000, 1);
  for (const bool at_close : {false, true}) {
    const TemporaryFolder folder;
    const fs::path partial = fs::canonical(folder.path()) / "a.h5.partial";
    {
      SessionWriter writer(folder / "a.h5", example_info());
      writer.append(std::span(samples).first(6000));
      writer.flush();
      EXPECT_TRUE(writer.can_go_on());
      // From here on every write meets a full device, though space was there before.
      const int full = open("/dev/full", O_RDWR);
      const int under = descriptor_of(partial);
      ASSERT_GE(under, 0);
      ASSERT_GE(dup2(full, under), 0);
      close(full);
      const std::string message = message_of<RunError>([&] {
        if (!at_close) {
          writer.append(std::span(samples).subspan(6000));
        }
        writer.close();
      });
      EXPECT_FALSE(writer.can_go_on());
      EXPECT_THAT(message, HasSubstr("No space left on device"));
      EXPECT_THROW(writer.close(), RunError);
    }
    EXPECT_EQ(SessionReader(partial).sample_count(), 6000u);
    expect_prefix(partial, samples);
  }
}

}  // namespace
}  // namespace haptrial::record::session_writer_test
