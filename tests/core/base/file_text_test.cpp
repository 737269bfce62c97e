#include "core/base/file_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

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

}  // namespace
}  // namespace haptrial
