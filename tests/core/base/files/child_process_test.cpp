#include "core/base/files/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "core/base/files/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

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

TEST(ChildProcessTest, ACopyCanCrashThrowOrHang) {
  EXPECT_EQ(ChildProcess([] {}).wait(), 0);
  EXPECT_EQ(ChildProcess([] { throw std::runtime_error("no"); }).wait(), 1);
  EXPECT_EQ(ChildProcess([] { std::abort(); }).wait(), -1);
  const auto start = std::chrono::steady_clock::now();
  {
    const ChildProcess left([] { pause(); });
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(ChildProcessTest, WordsOfACopyComeWhole) {
  const std::string words(300'000, 'w');  // more than a pipe holds
  Pipe pipe;
  ChildProcess child([&] { write_fully(pipe.to.get(), words.data(), words.size()); });
  pipe.to.close();
  EXPECT_EQ(read_to_end(pipe.from.get()), words);
  EXPECT_EQ(child.wait(), 0);
}

TEST(ChildProcessTest, ReadingCanBeGivenUp) {
  const Pipe pipe;
  int asked = 0;
  EXPECT_EQ(read_to_end(pipe.from.get(), [&] { return ++asked < 2; }), "");
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace haptrial
