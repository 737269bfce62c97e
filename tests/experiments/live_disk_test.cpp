// A disk that is full in the middle of a session: a limit on the size of files does the same and
// needs no privilege.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::LiveCommand;
using testing::HasSubstr;

TEST(LiveDiskTest, AFullDiskEndsTheSessionInASentenceAndItGoesOnWhereThereIsRoom) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "the sanitizer keeps files of its own, which the limit breaks";
  }
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", test::brisk_text());
  const std::string run = "run '" + (folder / "study.toml").string() +
                          "' --subject S01 --trials 2 --out '" + (folder / "out").string() + "' ";
  const CommandResult full = LiveCommand(run, "ulimit -f 360").wait();
  EXPECT_EQ(full.status, 1) << full.output;
  EXPECT_EQ(std::count(full.errors.begin(), full.errors.end(), '\n'), 1) << full.errors;
  EXPECT_THAT(full.errors, HasSubstr("S01.h5: the session cannot be written (File too large)"));
  EXPECT_THAT(full.output, HasSubstr("S01.h5")) << "what is recorded, and where";

  const fs::path partial = folder / "out/S01.h5.partial";
  ASSERT_TRUE(fs::exists(partial));
  EXPECT_FALSE(fs::exists(folder / "out/S01.h5"));
  const CommandResult info = test::run_command("haptrial info '" + partial.string() + "'");
  EXPECT_EQ(info.status, 1) << "not complete";
  EXPECT_THAT(info.output, HasSubstr(" 0 gaps"));
  const std::uint64_t rows = record::SessionReader(partial).sample_count();
  EXPECT_GT(rows, 1000u) << "what came before is there";
  const CommandResult python = test::run_command(
      "/usr/bin/python3 -c 'import h5py, sys\nwith h5py.File(sys.argv[1], \"r\") as f:\n"
      "    s = f[\"samples\"][:]\n"
      "    assert (s[\"sequence\"] == range(len(s))).all()\n"
      "    print(len(s))' '" +
      partial.string() + "'");
  EXPECT_EQ(python.status, 0) << python.errors;
  EXPECT_EQ(python.output, std::to_string(rows) + "\n");

  const CommandResult again = LiveCommand(run + "--resume").wait();
  ASSERT_EQ(again.status, 0) << again.errors;
  const record::SessionReader reader(folder / "out/S01.h5");
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
  std::vector<int> tested;
  for (const record::PassRow& pass : reader.passes()) {
    if (pass.phase == record::Phase::kTest && pass.status == record::PassStatus::kCompleted) {
      tested.push_back(pass.trial);
    }
  }
  EXPECT_THAT(tested, testing::ElementsAre(1, 2));
}

TEST(LiveDiskTest, ADryRunOnAFullDiskSaysThatNothingIsKept) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "the sanitizer keeps files of its own, which the limit breaks";
  }
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", test::brisk_text());
  const fs::path out = folder / "out";
  const CommandResult full = LiveCommand("dry-run '" + (folder / "study.toml").string() +
                                             "' --trials 2 --out '" + out.string() + "'",
                                         "ulimit -f 360")
                                 .wait();
  EXPECT_EQ(full.status, 1) << full.output;
  EXPECT_THAT(full.errors, HasSubstr("out is removed: a dry run is kept whole or not at all"));
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace haptrial
