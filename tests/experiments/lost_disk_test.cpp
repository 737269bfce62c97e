// The disk fills up in the middle of a session while a device is under force.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/base/dynamic_library.h"
#include "core/base/error.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/force_log.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::lost_disk_test {
namespace {

namespace fs = std::filesystem;
const std::string kLibrary = std::string(HAPTRIAL_BINARY_DIR) + "/libstand_in_dhd.so";

/// Runs a session in a process of its own, whose files may not grow far. Leaves every force that
/// the motors were given and the error.
void run_until_the_disk_is_full(const SessionRequest& request, const fs::path& folder) {
  ::setenv("STAND_IN_FORCES", (folder / "forces").c_str(), 1);
  const DynamicLibrary library(kLibrary, "the stand-in");  // its record is mapped now
  std::ofstream out(folder / "error.txt");
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{400'000, 400'000};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    run_session(request);
  } catch (const RunError& thrown) {
    out << thrown.what() << "\n";
  }
}

TEST(LostDiskTest, TheForceFadesAndWhatWasRecordedIsKept) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  const test::TemporaryFolder folder;
  protocols::ForceDefinition definition =
      protocols::parse_force_definition(test::shipped_text(), "shipped.toml");
  SessionRequest request =
      test::session_request(protocols::force_training(), definition, folder / "P01.h5", 0, "P01");
  request.clock = realtime::ClockKind::kReal;
  request.device = {"force-dimension", kLibrary};
  const pid_t child = fork();
  if (child == 0) {
    run_until_the_disk_is_full(request, folder.path());
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);

  const std::string error = test::read_text(folder / "error.txt");
  EXPECT_THAT(error, testing::HasSubstr("the session cannot be written"));
  EXPECT_THAT(error, testing::HasSubstr("File too large"));
  std::vector<double> forces;  // tick by tick
  for (const test::Commanded& each : test::read_force_log(folder / "forces")) {
    forces.push_back(each.force);
  }
  ASSERT_GT(forces.size(), 1000u);
  ASSERT_EQ(forces.back(), 0.0);
  std::size_t last = forces.size() - 1;  // under force
  while (last > 0 && forces[last] == 0.0) {
    --last;
  }
  ASSERT_GT(last, 50u);
  const double before = forces[last - 50];
  EXPECT_GT(before, 0.1) << "there was a force to lose";
  EXPECT_LT(forces[last], 0.3 * before) << "let go, not cut";

  const record::SessionReader reader(folder / "P01.h5.partial");
  EXPECT_GT(reader.sample_count(), 800u);
}

}  // namespace

// A disk that is full in the middle of a session: a limit on the size of files does the same and
// needs no privilege.

namespace {

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
}  // namespace haptrial::experiments::lost_disk_test
