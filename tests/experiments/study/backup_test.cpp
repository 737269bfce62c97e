// The copy of an ended session on another disk: whole, or not there and said.

#include "experiments/study/backup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <filesystem>

#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::backup_test {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::write_text;
using testing::HasSubstr;

class BackupTest : public testing::Test {
 protected:
  BackupTest() {
    fs::create_directory(disk_);
    for (int i = 0; i < 300'000; ++i) {
      content_ += static_cast<char>(std::uint64_t(i) * 7919 / 13);
    }
    write_text(session_, content_);
  }
  BackupResult back_up_now() const { return try_back_up(session_, disk_, "study"); }

  test::TemporaryFolder folder_;
  fs::path session_{folder_ / "P01.h5"};
  fs::path disk_{folder_ / "disk"};
  fs::path copy_{disk_ / "study/P01.h5"};
  fs::path part_{disk_ / "study/P01.h5.copying"};
  std::string content_;
};

TEST_F(BackupTest, ACopyHasEveryByteAndASecondBackupFindsIt) {
  EXPECT_EQ(back_up(session_, disk_, "study"), copy_);
  EXPECT_EQ(read_text(copy_), content_);
  EXPECT_FALSE(fs::exists(part_));
  const auto time = fs::last_write_time(copy_);
  const BackupResult again = back_up_now();
  EXPECT_TRUE(again.kept);
  EXPECT_THAT(again.sentence, HasSubstr(copy_.string()));
  EXPECT_EQ(fs::last_write_time(copy_), time) << "it is not written again";
  EXPECT_EQ(read_text(session_), content_);
}

TEST_F(BackupTest, StudiesWithParticipantsOfTheSameNamesDoNotMeet) {
  back_up(session_, disk_, "study");
  write_text(session_, "another study's P01");
  EXPECT_EQ(read_text(back_up(session_, disk_, "other")), "another study's P01");
  EXPECT_EQ(read_text(copy_), content_);
}

/// The mount point of a disk that is not plugged in must not be filled in its place.
TEST_F(BackupTest, AMissingFolderIsNotMade) {
  fs::remove(disk_);
  const BackupResult result = back_up_now();
  EXPECT_FALSE(result.kept);
  EXPECT_THAT(result.sentence, HasSubstr("THE SESSION HAS NO BACKUP"));
  EXPECT_THAT(result.sentence, HasSubstr("is its disk plugged in?"));
  EXPECT_THAT(result.sentence, HasSubstr("Copy it by hand"));
  EXPECT_FALSE(fs::exists(disk_));
  EXPECT_EQ(read_text(session_), content_);
}

TEST_F(BackupTest, AnotherFileOfTheNameStaysAsItIs) {
  fs::create_directory(disk_ / "study");
  std::string other = content_;
  other.back() = static_cast<char>(other.back() + 1);
  write_text(copy_, other);
  const BackupResult result = back_up_now();
  EXPECT_FALSE(result.kept);
  EXPECT_THAT(result.sentence, HasSubstr("is another file of this name"));
  EXPECT_EQ(read_text(copy_), other);
}

TEST_F(BackupTest, WhatAnInterruptedCopyLeftIsReplaced) {
  fs::create_directory(disk_ / "study");
  write_text(part_, content_ + "longer than the session");
  EXPECT_TRUE(back_up_now().kept);
  EXPECT_EQ(read_text(copy_), content_);
  EXPECT_FALSE(fs::exists(part_));
}

/// A limit on the size of files does what a full disk does, and needs no privilege.
TEST_F(BackupTest, AFullDiskLeavesNoCopyAndTheSessionAsItIs) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "the sanitizer keeps files of its own, which the limit breaks";
  }
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{100'000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
  const BackupResult result = back_up_now();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(result.kept);
  EXPECT_THAT(result.sentence, HasSubstr("cannot be written (File too large)"));
  EXPECT_FALSE(fs::exists(copy_));
  EXPECT_FALSE(fs::exists(part_)) << "the room is free again";
  EXPECT_EQ(read_text(session_), content_);
  EXPECT_TRUE(back_up_now().kept) << "once there is room";
}

TEST_F(BackupTest, AFolderThatMayNotBeWrittenIsSaid) {
  write_text(disk_ / "study", "a file in the place of the folder");
  const BackupResult result = back_up_now();
  EXPECT_FALSE(result.kept);
  EXPECT_THAT(result.sentence, HasSubstr((disk_ / "study").string()));
}

}  // namespace
}  // namespace haptrial::experiments::backup_test
