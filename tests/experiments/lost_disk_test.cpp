// The disk fills up in the middle of a session while a device is under force.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <vector>

#include "core/base/dynamic_library.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/force_log.h"
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
  SessionRequest request;
  request.protocol = &protocols::force_training();
  request.definition = &definition;
  request.subject = "P01";
  request.clock = realtime::ClockKind::kReal;
  request.device = {"force-dimension", kLibrary};
  request.file = folder / "P01.h5";
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
}  // namespace haptrial::experiments::lost_disk_test
