#include "core/record/hdf5/disk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <thread>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/table/schema.h"
#include "tests/core/record/disk_tap.h"
#include "tests/core/record/session_fixture.h"
#include "tests/support/message_of.h"
#include "tests/support/wait.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using test::DiskStep;
using test::DiskTap;
using test::hand_motion;
using test::message_of;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;

SessionInfo live_info() {
  SessionInfo info = test::example_info();
  info.clock = "real";
  return info;
}

/// Flushes until the writer has something to say.
std::vector<std::string> next_notices(SessionWriter& writer) {
  std::vector<std::string> notices;
  test::wait_until([&] {
    writer.flush();
    notices = writer.take_notices();
    return !notices.empty();
  });
  return notices;
}

/// A disk on which no sync ends before it is let go.
class SlowDisk {
 public:
  SlowDisk() {
    DiskTap::instead_of_fdatasync([this](int) {
      ++syncs_;
      std::unique_lock lock(mutex_);
      go_.wait(lock, [this] { return !held_; });
      return 0;
    });
  }
  ~SlowDisk() {
    let_go();
    DiskTap::instead_of_fdatasync(nullptr);
  }
  void let_go() {
    const std::lock_guard lock(mutex_);
    held_ = false;
    go_.notify_all();
  }
  void hold() {
    const std::lock_guard lock(mutex_);
    held_ = true;
  }
  int syncs() const { return syncs_; }

 private:
  std::mutex mutex_;
  std::condition_variable go_;
  bool held_{false};
  std::atomic<int> syncs_{0};
};

TEST(DiskSyncTest, SyncsAgainAndAgainWithoutBeingAsked) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", live_info());
  SlowDisk disk;
  test::wait_until([&] { return disk.syncs() >= 3; });
}

TEST(DiskSyncTest, ASessionOnASimulatedClockDoesNotSync) {
  const TemporaryFolder folder;
  SlowDisk disk;
  SessionWriter writer(folder / "a.h5", test::example_info());
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  EXPECT_EQ(disk.syncs(), 0);
}

/// Everything is written while a sync hangs: were one call to wait for it, this would not end.
TEST(DiskSyncTest, NobodyWaitsForASlowDisk) {
  const TemporaryFolder folder;
  SlowDisk disk;
  SessionWriter writer(folder / "a.h5", live_info());
  disk.hold();
  const int before = disk.syncs();
  test::wait_until([&] { return disk.syncs() > before; });
  const std::vector<Sample> samples = hand_motion(20000, 1);
  for (std::size_t at = 0; at < samples.size(); at += 500) {
    writer.append(std::span(samples).subspan(at, 500));
    writer.add_event({static_cast<std::int64_t>(at), "note", ""});
    writer.flush();
    writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, at, at + 499, {}});
    writer.sync_soon();
  }
  EXPECT_EQ(disk.syncs(), before + 1);  // which still hangs
  disk.let_go();
  test::wait_until([&] { return disk.syncs() > before + 1; });
}

/// Bytes in the file when a sync began are among those that it covers.
TEST(DiskSyncTest, AChunkAndAPassAreSyncedSoon) {
  const TemporaryFolder folder;
  SlowDisk disk;
  SessionWriter writer(folder / "a.h5", live_info());
  disk.hold();  // the next sync by the clock is half a second away at most
  const int before = disk.syncs();
  test::wait_until([&] { return disk.syncs() > before; });
  writer.append(hand_motion(768, 1));
  disk.let_go();  // asked for meanwhile: it begins at once
  test::wait_until([&] { return disk.syncs() >= before + 2; });
}

/// Five seconds of a pass that does not end: rows that a power cut would cost at its worst moment.
TEST(DiskSyncTest, APassThatDoesNotEndIsOnTheDiskAllTheWhile) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(5000, 3);
  const std::size_t chunk = live_chunk_rows(1000.0);
  std::atomic<std::size_t> given{0}, safe{0};
  SessionWriter writer(folder / "a.h5", live_info());
  DiskTap::instead_of_fdatasync([&](int descriptor) {
    const std::size_t in_file = given - given % chunk;
    const int status = static_cast<int>(syscall(SYS_fdatasync, descriptor));
    safe = in_file;
    return status;
  });
  std::size_t worst = 0;
  const auto start = std::chrono::steady_clock::now();
  while (given < samples.size()) {
    writer.append(std::span(samples).subspan(given, 20));
    given += 20;
    if (given % 500 == 0) {
      writer.flush();
    }
    worst = std::max(worst, given - safe);
    std::this_thread::sleep_until(start + std::chrono::milliseconds(given.load()));
  }
  test::wait_until([&] { return safe > 0; });
  DiskTap::instead_of_fdatasync(nullptr);
  std::printf("a power cut would have cost %.2f s at most\n", 1e-3 * static_cast<double>(worst));
}

TEST(DiskSyncTest, ADiskThatRefusesEndsTheSessionInASentence) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", live_info());
  DiskTap::instead_of_fdatasync([](int) {
    errno = EIO;
    return -1;
  });
  const std::string said = message_of<RunError>([&] {
    for (;;) {
      writer.flush();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  DiskTap::instead_of_fdatasync(nullptr);
  EXPECT_THAT(said, HasSubstr("the session cannot be written (Input/output error)"));
}

TEST(LostFileTest, ADeletedFileIsThereAgainWithEverything) {
  const TemporaryFolder folder;
  std::vector<Sample> samples = hand_motion(5000, 2);
  for (Sample& sample : samples) {
    sample.pass = -1;
  }
  SessionWriter writer(folder / "a.h5", live_info());
  writer.append(std::span(samples).first(2000));
  writer.add_event({1, "note", "before"});
  fs::remove(folder / "a.h5.partial");
  EXPECT_THAT(next_notices(writer),
              testing::ElementsAre(HasSubstr("a.h5.partial was deleted while the session ran")));
  EXPECT_EQ(SessionReader(folder / "a.h5.partial").sample_count(), 2000u);
  writer.append(std::span(samples).subspan(2000));
  writer.set_timing({}, {5000, 0, 0});
  writer.close();
  const SessionReader reader(folder / "a.h5");
  EXPECT_TRUE(check_session(reader).ok);
  ASSERT_EQ(reader.sample_count(), 5000u);
  EXPECT_EQ(reader.events().size(), 1u);
  const std::vector<Sample> back = reader.samples(0, 5000);
  for (std::size_t i = 0; i < back.size(); ++i) {
    ASSERT_TRUE(test::same(back[i], test::on_file(samples[i]))) << i;
  }
}

TEST(LostFileTest, AMovedFileHasItsNameAgain) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", live_info());
  writer.append(hand_motion(2000, 2));
  fs::rename(folder / "a.h5.partial", folder / "elsewhere");
  EXPECT_THAT(next_notices(writer), testing::ElementsAre(HasSubstr("was moved")));
  EXPECT_TRUE(fs::equivalent(folder / "a.h5.partial", folder / "elsewhere"));
  writer.close();
  EXPECT_EQ(SessionReader(folder / "a.h5").sample_count(), 2000u);
}

TEST(LostFileTest, ADeletedFolderIsMadeAgainWithEverything) {
  const TemporaryFolder folder;
  const fs::path sessions = folder / "out" / "sessions";
  fs::create_directories(sessions);
  SessionWriter writer(sessions / "a.h5", live_info());
  writer.append(hand_motion(2000, 2));
  fs::remove_all(folder / "out");
  EXPECT_THAT(next_notices(writer),
              testing::ElementsAre(HasSubstr("sessions was deleted or moved while the session ran, "
                                             "and was made again"),
                                   HasSubstr("a.h5.partial was deleted while")));
  writer.close();
  EXPECT_EQ(SessionReader(sessions / "a.h5").sample_count(), 2000u);
}

TEST(LostFileTest, OfARenamedFolderItIsSaidWhereTheRecordingLies) {
  const TemporaryFolder folder;
  const fs::path sessions = folder / "sessions";
  fs::create_directories(sessions);
  SessionWriter writer(sessions / "a.h5", live_info());
  writer.append(hand_motion(2000, 2));
  fs::rename(sessions, folder / "renamed");
  const fs::path lay = fs::canonical(folder / "renamed") / "a.h5.partial";
  EXPECT_THAT(next_notices(writer),
              testing::ElementsAre(HasSubstr("was made again"),
                                   HasSubstr("while the session ran, to " + lay.string())));
  EXPECT_TRUE(fs::equivalent(sessions / "a.h5.partial", lay));
  writer.close();
  EXPECT_EQ(SessionReader(sessions / "a.h5").sample_count(), 2000u);
}

TEST(LostFileTest, WithoutAFolderItIsSaidWhereTheRecordingLies) {
  const TemporaryFolder folder;
  const fs::path sessions = folder / "out" / "sessions";
  fs::create_directories(sessions);
  SessionWriter writer(sessions / "a.h5", live_info());
  writer.append(hand_motion(2000, 2));
  fs::rename(folder / "out", folder / "renamed");
  std::ofstream(folder / "out") << "a file in the folder's place";
  const std::string said = message_of<RunError>([&] { writer.close(); });
  const fs::path lies = fs::canonical(folder / "renamed") / "sessions" / "a.h5.partial";
  EXPECT_THAT(said, HasSubstr("cannot be made again"));
  EXPECT_THAT(said, HasSubstr("what came before is in " + lies.string()));
}

TEST(LostFileTest, AReplacedFileIsSavedAndTheOtherLeftAlone) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", live_info());
  writer.append(hand_motion(2000, 2));
  std::ofstream(folder / "other") << "not ours";
  fs::rename(folder / "other", folder / "a.h5.partial");
  std::string said;
  test::wait_until([&] {
    try {
      writer.flush();
    } catch (const RunError& error) {
      said = error.what();
    }
    return !said.empty();
  });
  EXPECT_THAT(said, HasSubstr("was replaced by another file while the session ran"));
  EXPECT_THAT(said, HasSubstr("a.h5.partial.saved"));
  EXPECT_EQ(file_text(folder / "a.h5.partial"), "not ours");
  fs::copy_file(folder / "a.h5.partial.saved", folder / "copy.h5");
  EXPECT_EQ(SessionReader(folder / "copy.h5").sample_count(), 2000u);
}

TEST(LostFileTest, AFileThatAnotherProgramCutsIsNotCalledComplete) {
  for (const std::uintmax_t left : {std::uintmax_t{0}, std::uintmax_t{20'000}}) {
    const TemporaryFolder folder;
    SessionWriter writer(folder / "a.h5", live_info());
    const std::vector<Sample> samples = hand_motion(4000, 2);
    writer.append(std::span(samples).first(2000));
    writer.sync();
    fs::resize_file(folder / "a.h5.partial", left);
    writer.append(std::span(samples).subspan(2000));
    const std::string said = message_of<RunError>([&] { writer.close(); });
    EXPECT_THAT(said, HasSubstr("the session does not read back")) << left;
    EXPECT_THAT(said, HasSubstr("haptrial recover"));
    EXPECT_FALSE(fs::exists(folder / "a.h5"));
    EXPECT_TRUE(fs::exists(folder / "a.h5.partial"));
  }
}

TEST(LostFileTest, DeletedBeforeTheEndIsNoticedAtTheEnd) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", live_info());
  writer.append(hand_motion(2000, 2));
  fs::remove(folder / "a.h5.partial");
  writer.close();
  EXPECT_EQ(SessionReader(folder / "a.h5").sample_count(), 2000u);
}

}  // namespace
}  // namespace haptrial::record
