// The disk fills up in the middle of a session while a device is under force.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/device/dynamic_library.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/stand_in.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::lost_disk_test {
namespace {

namespace fs = std::filesystem;
const std::string kLibrary = std::string(HAPTRIAL_BINARY_DIR) + "/libstand_in_dhd.so";

/// Looks at the motors of the stand-in library a thousand times a second.
class MotorWatch {
 public:
  MotorWatch() {
    library_.get(view_, "stand_in_view");
    forces_.reserve(1 << 16);
    thread_ = std::thread([this] {
      while (!over_ && forces_.size() < forces_.capacity()) {
        test::StandInView seen{};
        view_(&seen);
        forces_.push_back(Eigen::Vector3d(seen.force[0], seen.force[1], seen.force[2]).norm());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  const std::vector<double>& stop() {
    over_ = true;
    thread_.join();
    return forces_;
  }

 private:
  device::DynamicLibrary library_{kLibrary, "the stand-in"};
  void (*view_)(test::StandInView*){nullptr};
  std::vector<double> forces_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// In a process of its own, whose files may not grow far. Leaves the motors' forces and the error.
void run_until_the_disk_is_full(const SessionRequest& request, const fs::path& forces) {
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{400'000, 400'000};
  setrlimit(RLIMIT_FSIZE, &limit);
  MotorWatch watch;
  std::string error = "none";
  try {
    run_session(request);
  } catch (const RunError& thrown) {
    error = thrown.what();
  }
  std::ofstream out(forces);
  out << error << "\n";
  for (const double force : watch.stop()) {
    out << force << "\n";
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
    run_until_the_disk_is_full(request, folder / "forces.txt");
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);

  std::ifstream in(folder / "forces.txt");
  std::string error;
  std::getline(in, error);
  EXPECT_THAT(error, testing::HasSubstr("the session cannot be written"));
  EXPECT_THAT(error, testing::HasSubstr("File too large"));
  std::vector<double> forces;
  for (double force = 0.0; in >> force;) {
    forces.push_back(force);
  }
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
