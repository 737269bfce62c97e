#include <gmock/gmock.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using testing::HasSubstr;

TEST(FileTextTest, GivesEveryByte) {
  const test::TemporaryFolder folder;
  for (const std::string& text : {std::string(), std::string("a\r\n\0\xff b", 7)}) {
    std::ofstream(folder / "file", std::ios::binary) << text;
    EXPECT_EQ(file_text(folder / "file"), text);
  }
}

TEST(FileTextTest, WhatCannotBeReadIsNotAnEmptyText) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::message_of([&] { file_text(folder / "absent"); }),
              HasSubstr("absent: cannot be read: No such file"));
  EXPECT_THAT(test::message_of([&] { file_text(folder / std::string(300, 'a')); }),
              HasSubstr("cannot be read: File name too long"));
}

TEST(FileTextTest, WhatMayNeverEndIsRefused) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder / "zeros");
  for (const char* name : {"pipe", "zeros"}) {
    const std::string sentence = std::string(name) + ": is not a regular file; give a file";
    EXPECT_THAT(test::message_of([&] { file_text(folder / name); }), HasSubstr(sentence));
    EXPECT_THAT(test::message_of([&] { file_head(folder / name, 8); }), HasSubstr(sentence));
  }
  EXPECT_THAT(test::message_of([&] { file_text(folder.path()); }), HasSubstr(": is a directory"));
}

TEST(FileTextTest, AHeadIsAsLongAsTheFileAllows) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file", std::ios::binary) << "abc";
  EXPECT_EQ(file_head(folder / "file", 2), "ab");
  EXPECT_EQ(file_head(folder / "file", 8), "abc");
}

namespace fs = std::filesystem;

TEST(WholeFileTest, TheTargetOfALinkIsReplaced) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "common");
  std::ofstream(folder / "common/study.toml") << "old";
  fs::create_symlink("common/study.toml", folder / "study.toml");
  fs::create_symlink("study.toml", folder / "again.toml");
  write_whole(folder / "again.toml", "new");
  EXPECT_EQ(file_text(folder / "common/study.toml"), "new");
  EXPECT_TRUE(fs::is_symlink(folder / "study.toml"));
  EXPECT_TRUE(fs::is_symlink(folder / "again.toml"));
}

TEST(WholeFileTest, APipeIsNotReplaced) {
  const test::TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(write_whole(pipe, "new"), InputError);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(WholeFileTest, AReplacedFileKeepsItsMode) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "file";
  for (const fs::perms mode : {fs::perms(0600), fs::perms(0664), fs::perms(0755)}) {
    std::ofstream(file) << "old";
    fs::permissions(file, mode);
    write_whole(file, "new");
    EXPECT_EQ(file_text(file), "new");
    EXPECT_EQ(fs::status(file).permissions(), mode);
  }
}

/// A file of Bob's group, with mode 0660, is replaced by Alice. @returns what it is then
struct stat replaced_by_alice(gid_t group_of_alice) {
  constexpr uid_t kBob = 40001, kAlice = 40002;
  constexpr gid_t kLab = 40003;
  const test::TemporaryFolder folder;
  const fs::path file = folder / "study.toml";
  std::ofstream(file) << "old";
  fs::permissions(file, fs::perms(0660));
  EXPECT_EQ(chown(file.c_str(), kBob, kLab), 0);
  EXPECT_EQ(chown(folder.path().c_str(), kAlice, kAlice), 0);
  EXPECT_EQ(setgroups(1, &group_of_alice), 0);
  EXPECT_EQ(setegid(kAlice), 0);
  EXPECT_EQ(seteuid(kAlice), 0);
  EXPECT_NO_THROW(write_whole(file, "new"));
  EXPECT_EQ(seteuid(0), 0);
  EXPECT_EQ(setegid(0), 0);
  EXPECT_EQ(setgroups(0, nullptr), 0);
  EXPECT_EQ(file_text(file), "new");
  struct stat now {};
  EXPECT_EQ(stat(file.c_str(), &now), 0);
  EXPECT_EQ(now.st_uid, kAlice);
  return now;
}

/// Only root can be two people here.
TEST(WholeFileTest, AReplacedFileOfAnotherOwnerKeepsItsGroupOrIsClosedToOthers) {
  if (geteuid() != 0 || setgroups(0, nullptr) != 0) {
    GTEST_SKIP() << "takes root's rights";
  }
  constexpr gid_t kAlice = 40002, kLab = 40003;
  const struct stat shared = replaced_by_alice(kLab);
  EXPECT_EQ(shared.st_gid, kLab);
  EXPECT_EQ(shared.st_mode & 0777, 0660U);
  const struct stat own = replaced_by_alice(kAlice);
  EXPECT_EQ(own.st_gid, kAlice);
  EXPECT_EQ(own.st_mode & 0777, 0600U) << "what the lab's people might, Alice's group may not";
}

TEST(WholeFileTest, AReplacedFileIsPrivateUntilItIsThere) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "old";
  fs::permissions(folder / "file", fs::perms(0640));
  WholeFile whole(folder / "file", true);
  EXPECT_EQ(fs::status(whole.part()).permissions() & fs::perms(0077), fs::perms::none);
  whole.finish();
  EXPECT_EQ(fs::status(folder / "file").permissions(), fs::perms(0640));
}

}  // namespace

}  // namespace haptrial
