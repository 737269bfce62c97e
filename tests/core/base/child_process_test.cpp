#include "core/base/child_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(ChildProcessTest, AProgramHasItsStreamsItsFolderAndItsStatus) {
  const test::TemporaryFolder folder;
  write_text(folder / "given", "one\ntwo\n");
  const Descriptor given(open((folder / "given").c_str(), O_RDONLY | O_CLOEXEC));
  Pipe pipe;
  ChildProcess child({.words = {"sh", "-c", "cat; pwd; echo wrong >&2; exit 7"},
                      .folder = folder.path(),
                      .input = given.get(),
                      .output = pipe.to.get()});
  pipe.to.close();
  EXPECT_EQ(read_to_end(pipe.from.get()),
            "one\ntwo\n" + std::filesystem::canonical(folder.path()).string() + "\nwrong\n");
  EXPECT_EQ(child.wait(), 7);
  EXPECT_EQ(child.wait(), 7);
}

TEST(ChildProcessTest, AProgramThatIsNotThereIsSaid) {
  EXPECT_THROW(ChildProcess({.words = {"haptrial-has-no-such-program"}}), std::system_error);
}

TEST(ChildProcessTest, AProgramHasNoOtherDescriptor) {
  const test::TemporaryFolder folder;
  const Descriptor secret(open((folder / "secret").c_str(), O_RDWR | O_CREAT, 0600));
  ASSERT_GT(secret.get(), STDERR_FILENO);
  Pipe pipe;
  ChildProcess child({.words = {"sh", "-c", "readlink /proc/$$/fd/*; ls /proc/$$/fd; true"},
                      .output = pipe.to.get()});
  pipe.to.close();
  const std::string words = read_to_end(pipe.from.get());
  EXPECT_THAT(words, HasSubstr("/dev/null"));
  EXPECT_THAT(words, Not(HasSubstr("secret")));
  EXPECT_THAT(words, EndsWith("\n0\n1\n2\n"));
}

TEST(ChildProcessTest, WhatAProgramLeavesBehindEndsWithIt) {
  for (const char* words : {"sleep 100000 & exit 0", "sleep 100000 & echo up; sleep 100000"}) {
    Pipe pipe;
    {
      ChildProcess child({.words = {"sh", "-c", words}, .output = pipe.to.get()});
      pipe.to.close();
      if (std::string_view(words).find("up") == std::string_view::npos) {
        EXPECT_EQ(child.wait(), 0);
      } else {
        std::array<char, 3> up{};
        EXPECT_EQ(read(pipe.from.get(), up.data(), up.size()), 3);
      }
    }
    EXPECT_EQ(read_to_end(pipe.from.get()), "") << "no writer is left";
  }
}

TEST(ChildProcessTest, ACopyCanCrashThrowOrHang) {
  EXPECT_EQ(ChildProcess([] {}).wait(), 0);
  EXPECT_EQ(ChildProcess([] { throw std::runtime_error("no"); }).wait(), 1);
  EXPECT_EQ(ChildProcess([] { std::abort(); }).wait(), -1);
  const ChildProcess left([] { pause(); });  // its end does not wait for the copy's
}

TEST(ChildProcessTest, WordsOfACopyComeWhole) {
  const std::string words(300'000, 'w');  // more than a pipe holds
  Pipe pipe;
  ChildProcess child([&] { write_fully(pipe.to.get(), words.data(), words.size()); });
  pipe.to.close();
  EXPECT_EQ(read_to_end(pipe.from.get()), words);
  EXPECT_EQ(child.wait(), 0);
}

/// The signal of a broken pipe would end the test.
TEST(ChildProcessTest, AReaderThatHasLeftEndsTheWritingAlone) {
  Pipe pipe;
  pipe.from.close();
  EXPECT_FALSE(write_fully(pipe.to.get(), "words", 5));
}

TEST(ChildProcessTest, ReadingCanBeGivenUp) {
  const Pipe pipe;
  int asked = 0;
  EXPECT_EQ(read_to_end(pipe.from.get(), [&] { return ++asked < 2; }), "");
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace haptrial
