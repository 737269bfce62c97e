#include "core/record/read/readable.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

std::string session_bytes(const TemporaryFolder& folder) {
  SessionWriter writer(folder / "whole.h5", test::example_info());
  std::vector<Sample> samples = test::hand_motion(6000, 3);
  for (Sample& sample : samples) {
    sample.pass = -1;
  }
  writer.append(samples);
  writer.add_event({5, "note", "text"});
  writer.add_stimulus(std::vector<StimulusRow>{{1, 0.0, {0.1, 0, 0}, 1.0}});
  writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {6000, 0, 0});
  writer.close();
  return file_text(folder / "whole.h5");
}

std::string complaint(const TemporaryFolder& folder, const std::string& bytes) {
  std::ofstream(folder / "a.h5", std::ios::binary) << bytes;
  return what_cannot_be_read(folder / "a.h5").value_or("");
}

TEST(ReadableTest, AWholeFileCanBeRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(complaint(folder, session_bytes(folder)), "");
  EXPECT_EQ(what_cannot_be_read(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version1.hdf5"),
            std::nullopt);
}

TEST(ReadableTest, AFileThatIsStillWrittenCanBeRead) {
  const TemporaryFolder folder;
  SessionInfo info = test::example_info();
  info.clock = "real";
  SessionWriter writer(folder / "a.h5", info);
  writer.append(test::hand_motion(3000, 3));
  writer.sync();
  fs::copy_file(folder / "a.h5.partial", folder / "b.h5.partial");
  EXPECT_EQ(what_cannot_be_read(folder / "b.h5.partial"), std::nullopt);
}

TEST(ReadableTest, ATextThatDiffersFromItsCopyIsFound) {
  const TemporaryFolder folder;
  std::string bytes = session_bytes(folder);
  const std::size_t at = bytes.find("größer als 0");  // of HDF5's heap; the copy is compressed
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 'G';
  EXPECT_EQ(complaint(folder, bytes),
            "attribute definition of the file differs from its copy in /attributes");
}

TEST(ReadableTest, NothingIsLeftOfWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(complaint(folder, "no file"), HasSubstr("cannot be opened"));
}

/// Bits flipped all over the file: what h5py cannot read is never called intact.
TEST(ReadableTest, WhatH5pyCannotReadIsFound) {
  const TemporaryFolder folder;
  const std::string whole = session_bytes(folder);
  RandomStream random(9, "bits");
  constexpr int kFiles = 80;
  std::vector<bool> intact, rows_agree;
  std::ofstream list(folder / "files.txt");
  for (int i = 0; i < kFiles; ++i) {
    std::string bytes = whole;
    // Half of them where the structure and the texts are.
    const std::size_t at = random.below(i % 2 == 0 ? 16384 : bytes.size());
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
    const fs::path file = folder / fmt::format("{}.h5", i);
    std::ofstream(file, std::ios::binary) << bytes;
    bool agree = false;
    try {
      agree = check_session(SessionReader(file)).ok;
    } catch (const InputError&) {
      // It is refused, and so not called intact.
    }
    rows_agree.push_back(agree);
    intact.push_back(agree && !what_cannot_be_read(file));
    list << file.string() << '\n';
  }
  list.close();
  std::ofstream(folder / "read.py")
      << "import h5py, os, resource, sys\n"
         "def read(name):\n"
         "  with h5py.File(name, 'r') as f:\n"
         "    dict(f.attrs)\n"
         "    for d in f: f[d][:], dict(f[d].attrs)\n"
         "for name in open(sys.argv[1]).read().split():\n"
         "  child = os.fork()  # a process each: h5py may crash or hang on it\n"
         "  if child == 0:\n"
         "    resource.setrlimit(resource.RLIMIT_CPU, (20, 20))\n"
         "    try: read(name)\n"
         "    except BaseException: os._exit(1)\n"
         "    os._exit(0)\n"
         "  print(int(os.waitpid(child, 0)[1] == 0), flush=True)\n";
  const std::string command =
      fmt::format("/usr/bin/python3 {0}/read.py {0}/files.txt > {0}/said", folder.path().string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream said(folder / "said");
  int unreadable = 0, called_intact = 0, found_only_here = 0;
  for (int i = 0; i < kFiles; ++i) {
    int readable = -1;
    said >> readable;
    ASSERT_NE(readable, -1);
    unreadable += readable == 0 ? 1 : 0;
    called_intact += intact[static_cast<std::size_t>(i)] ? 1 : 0;
    found_only_here += readable == 0 && rows_agree[static_cast<std::size_t>(i)] ? 1 : 0;
    EXPECT_FALSE(readable == 0 && intact[static_cast<std::size_t>(i)]) << "file " << i;
  }
  std::printf(
      "%d files with a flipped bit: h5py cannot read %d, %d of which have rows that agree; "
      "%d are called intact\n",
      kFiles, unreadable, found_only_here, called_intact);
  EXPECT_GT(unreadable, kFiles / 20);
}

}  // namespace
}  // namespace haptrial::record
