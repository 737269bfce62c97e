// A session that is killed at each step of its closing.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/session_resume.h"
#include "tests/core/record/disk_tap.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using test::DiskTap;
using test::TemporaryFolder;

/// A session in a process of its own, killed before the step of its closing that is given.
/// @returns whether there was such a step
bool close_and_kill(const fs::path& file, const std::vector<Sample>& samples, int step) {
  const pid_t pid = fork();
  if (pid == 0) {
    SessionInfo info = test::example_info();
    info.clock = "real";
    SessionWriter writer(file, info);
    writer.append(samples);
    writer.sync();
    int left = step;
    const pid_t own = gettid();  // not the thread that syncs on its own
    DiskTap::before_each([&] {
      if (gettid() == own && left-- == 0) {
        kill(getpid(), SIGKILL);
      }
    });
    writer.add_event({1, "session_end", ""});
    writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {samples.size(), 3, 0});
    writer.close();
    _exit(0);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFSIGNALED(status);
}

TEST(ClosingKillTest, AtEachStepTheSessionCanBeBroughtToItsEnd) {
  const TemporaryFolder folder;
  std::vector<Sample> samples = test::hand_motion(3000, 4);
  for (Sample& sample : samples) {
    sample.pass = -1;
  }
  int step = 0, ended = 0, under_way = 0;
  for (bool killed = true; killed; ++step) {
    const fs::path file = folder / (std::to_string(step) + ".h5");
    killed = close_and_kill(file, samples, step);
    if (!fs::exists(file)) {
      Resumed found;
      SessionWriter writer = SessionWriter::resume(file, found);
      EXPECT_EQ(found.rows, samples.size());
      ++(found.ended ? ended : under_way);
      if (!found.ended) {
        writer.set_timing({}, {0, 0, 0});
      }
      writer.close();
    }
    const SessionReader reader(file);
    for (const std::string& problem : check_session(reader).problems) {
      ADD_FAILURE() << "step " << step << ": " << problem;
    }
    ASSERT_TRUE(reader.timing_summary()) << "step " << step;
    EXPECT_EQ(reader.timing_summary()->ticks, samples.size()) << "step " << step;
  }
  std::printf("%d steps of closing: %d times the session had ended, %d times it had not\n", step,
              ended, under_way);
  EXPECT_GT(ended, 3);
  EXPECT_GT(under_way, 1);
}

}  // namespace
}  // namespace haptrial::record
