#include "core/base/files/file_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

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
  for (const char* name : {"absent", "."}) {
    EXPECT_THAT(test::message_of([&] { file_text(folder / name); }), HasSubstr("cannot be read"));
  }
}

}  // namespace
}  // namespace haptrial
