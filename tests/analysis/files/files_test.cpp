#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "analysis/files/gzip_file.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// gzip is another program: what it reads back is what the file says to anybody.
std::string unpacked(const fs::path& file, const fs::path& to) {
  const std::string command = "gzip -dc '" + file.string() + "' >'" + to.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return file_text(to);
}

TEST(GzipFileTest, OtherProgramsReadTheSameText) {
  const test::TemporaryFolder folder;
  RandomStream random(5, "text");
  std::string text;
  while (text.size() < 3 * GzipFile::kMember + 12345) {
    text += std::to_string(random.normal()) + (random.uniform() < 0.1 ? "\n" : "\t");
  }
  GzipFile file(folder / "x.gz");
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = 1 + random.below(100'000);
    file.write(std::string_view(text).substr(at, size));
    at += size;
  }
  file.close();
  EXPECT_EQ(unpacked(folder / "x.gz", folder / "x"), text);
  EXPECT_LT(fs::file_size(folder / "x.gz"), 0.6 * static_cast<double>(text.size()));
}

TEST(GzipFileTest, NothingWrittenIsAnEmptyText) {
  const test::TemporaryFolder folder;
  GzipFile file(folder / "x.gz");
  file.close();
  EXPECT_EQ(unpacked(folder / "x.gz", folder / "x"), "");
}

// A limit on the size of files stands in for a full disk.
TEST(GzipFileTest, SaysThatTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const auto write_much = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = 100'000;
    setrlimit(RLIMIT_FSIZE, &limit);
    RandomStream random(5, "noise");
    try {
      GzipFile file(folder / "x.gz");
      for (int i = 0; i < 1'000'000; ++i) {
        file.write(std::string(1, static_cast<char>(random.below(256))));
      }
      file.close();
    } catch (const RunError& error) {
      std::fputs(error.what(), stderr);
      std::_Exit(7);
    }
    std::_Exit(9);
  };
  EXPECT_EXIT(write_much(), testing::ExitedWithCode(7), "x.gz: could not be written: File too lar");
}

TEST(NewFolderTest, AppearsWholeOrNotAtAll) {
  const test::TemporaryFolder root;
  {
    const NewFolder folder(root / "given up");
    folder.write("a/b.txt", "text");
    EXPECT_FALSE(fs::exists(root / "given up"));
  }
  EXPECT_EQ(entries(root.path()), 0u);
  NewFolder folder(root / "kept");
  folder.write("a/b.txt", "text");
  folder.publish();
  EXPECT_EQ(file_text(root / "kept/a/b.txt"), "text");
  EXPECT_EQ(entries(root.path()), 1u);
}

TEST(NewFolderTest, TakesAnEmptyOneAndNoOther) {
  const test::TemporaryFolder root;
  fs::create_directory(root / "empty");
  NewFolder folder(root / "empty/");
  folder.write("x", "1");
  folder.publish();
  EXPECT_EQ(file_text(root / "empty/x"), "1");
  try {
    const NewFolder again(root / "empty");
    ADD_FAILURE() << "took a folder that holds something";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is not empty; choose a new or an empty folder"));
  }
  std::ofstream(root / "file") << "x";
  EXPECT_THROW(NewFolder(root / "file"), InputError);
  EXPECT_THROW(NewFolder("/proc/no/such"), InputError);
  EXPECT_EQ(entries(root.path()), 2u);
}

TEST(NewFolderTest, DoesNotTakeThePlaceOfWhatCameMeanwhile) {
  const test::TemporaryFolder root;
  NewFolder folder(root / "x");
  fs::create_directory(root / "x");
  std::ofstream(root / "x/theirs") << "x";
  EXPECT_THROW(folder.publish(), RunError);
  EXPECT_EQ(file_text(root / "x/theirs"), "x");
}

}  // namespace
}  // namespace haptrial::exchange
